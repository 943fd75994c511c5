/* SPDX-License-Identifier: Apache-2.0 */
/* Motion of the compact body. A scene can only give a body one velocity, so the field is written
 * into the particles of the solver: waves of 16 cells with strain, shear and breathing in all
 * directions, fast enough for yielding bodies to yield everywhere and slow enough for few particles
 * to leave their cells. */
#ifndef BENCHMARK_MOTION_H
#define BENCHMARK_MOTION_H

#include "explicit/run.h"

/* Gives every particle the velocity of its body and of the field, this times `sign` (1 or -1: back
 * and forth, so that the shape is kept), and starts the run anew from there: nodes, books and
 * automatic step. */
TALUS_MUST_CHECK enum talus_status benchmark_set_motion(struct run *run, double sign,
                                                        struct talus_error *error);

/* Goes on with the other ordering, and with that share of the critical step, from the present
 * particles. */
TALUS_MUST_CHECK enum talus_status
benchmark_set_ordering(struct run *run, bool last, double courant, struct talus_error *error);

#endif

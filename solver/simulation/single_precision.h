/* SPDX-License-Identifier: Apache-2.0 */
/* Where single precision is safe: what rounding would do to a scene, estimated before it runs. The
 * reasons and measurements are in docs/single-precision.md. */
#ifndef TALUS_SINGLE_PRECISION_H
#define TALUS_SINGLE_PRECISION_H

#include "explicit/run.h"

struct single_precision {
    /* Share of its motion that the slowest body may lose in the rounding of positions. */
    double motion_error;
    /* Noise of stresses and forces over those of the weight (without gravity: of an impact). */
    double force_noise;
};

/* Out of a run that has been built, without particles, for steps of that length. */
struct single_precision single_precision_estimate(const struct run *run, double time_step);

/* TALUS_INVALID, at /solver/precision, for a scene that asks for single precision and would lose
 * what it is about. */
TALUS_MUST_CHECK enum talus_status single_precision_check(const struct run *run, double time_step,
                                                          struct talus_error *error);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* What makes a run unstable: found within the step, named (particle, place, time, quantity, what to
 * try). */
#ifndef TALUS_HEALTH_H
#define TALUS_HEALTH_H

#include "explicit/run.h"

/* A particle that left its cell: finite, and not farther than a cell in one step. */
TALUS_MUST_CHECK enum talus_status health_check_crosser(const struct run *run,
                                                        const struct particle_block *block,
                                                        size_t slot, struct talus_error *error);

/* A particle that left the grid or was taken out: an error, or booked as eliminated up to the
 * limit. */
TALUS_MUST_CHECK enum talus_status health_check_outside(const struct run *run,
                                                        const struct particle_record *record,
                                                        const double position[3],
                                                        struct talus_error *error);

/* Does the step of that number end with a look at the energy? */
bool health_checks_energy(uint64_t step);

/* Before particles change cells, so that the first that goes wrong is named: det of the incremental
 * deformation gradient. */
TALUS_MUST_CHECK enum talus_status health_check_deformation(const struct run *run,
                                                            const struct tile_sums *sums,
                                                            struct talus_error *error);

/* At the end of a step: speeds, and, when the speed has jumped or every 16 steps, energy against
 * the work done. */
TALUS_MUST_CHECK enum talus_status health_check_step(struct run *run, const struct tile_sums *sums,
                                                     struct talus_error *error);

/* Lumped masses of shape functions that are negative in places: TALUS_INVALID at the start,
 * TALUS_UNSTABLE later, with the node and its mass. */
TALUS_MUST_CHECK enum talus_status health_check_lumping(const struct run *run,
                                                        struct talus_error *error);

#endif

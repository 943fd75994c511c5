/* SPDX-License-Identifier: Apache-2.0 */
/* From the velocity gradient to trial strains, one block at a time. */
#ifndef TALUS_KINEMATICS_H
#define TALUS_KINEMATICS_H

#include "explicit/run.h"

/* Reads scratch->gradient; turns the stored strain into the trial strain as it is stored, and
 * advances the stored volume, F and total strain; writes strain (for the materials; not if the
 * strain is fitted over nodes, and then its trace is all that is wanted yet), rate, spin,
 * volume_ratio, reference_volume. Returns the smallest det of 1 + dt L of the block's particles, or
 * NAN. */
double kinematics_advance(struct run *run, const struct particle_block *block,
                          struct block_scratch *scratch, double time_step);

/* Elastic strain of the materials -> stored form, for slots whose strain the material changed
 * (plastic_strain > 0), or for `all` but volumetric materials. */
void kinematics_store(struct run *run, const struct particle_block *block,
                      struct block_scratch *scratch, bool all);

/* Rates and spins for the materials, out of scratch->gradient. */
void kinematics_rates(const struct run *run, struct block_scratch *scratch, size_t count,
                      double time_step);
/* Volumetric part of the stored strain, for what needs no more: 1/2 ln det b, trace, or ln J. */
void kinematics_traces(const struct run *run, const struct particle_block *block, real *trace);
/* scratch->reference_volume. */
void kinematics_volumes(const struct run *run, const struct particle_block *block,
                        struct block_scratch *scratch);

/* What kinematics_advance leaves in scratch for the materials but for rates, out of what it leaves
 * in the particles. */
void kinematics_reload(const struct run *run, const struct particle_block *block,
                       struct block_scratch *scratch);
/* Stored form -> strain of the materials, without motion (energies, frames). */
void kinematics_load(const struct run *run, const struct particle_block *block,
                     struct block_scratch *scratch);

#endif

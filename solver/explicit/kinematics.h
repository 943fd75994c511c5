/* SPDX-License-Identifier: Apache-2.0 */
/* From the velocity gradient to trial strains, one block at a time. */
#ifndef TALUS_KINEMATICS_H
#define TALUS_KINEMATICS_H

#include "explicit/run.h"

/* Reads scratch->gradient; turns the stored strain into the trial strain as it is stored, and
 * advances the stored volume, F and total strain; writes strain (for the materials), rate, spin,
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
/* scratch->reference_volume. */
void kinematics_volumes(const struct run *run, const struct particle_block *block,
                        struct block_scratch *scratch);

/* What kinematics_advance leaves in scratch for the materials but for rates, out of what it leaves
 * in the particles. */
void kinematics_recall(const struct run *run, const struct particle_block *block,
                       struct block_scratch *scratch);
/* True: for kinematics_recall the particles hold the trial strain that materials see, a logarithm
 * that costs more than to keep it, in the place of their stress, which is free until the material
 * has run. Who calls kinematics_advance puts it there. */
bool kinematics_carries(const struct run *run);
/* Stored form -> strain of the materials, without motion (energies, frames). */
void kinematics_load(const struct run *run, const struct particle_block *block,
                     struct block_scratch *scratch);

#endif

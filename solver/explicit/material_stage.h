/* SPDX-License-Identifier: Apache-2.0 */
/* Trial strain -> stress for one block: anti-locking and the materials of the block. */
#ifndef TALUS_MATERIAL_STAGE_H
#define TALUS_MATERIAL_STAGE_H

#include "explicit/run.h"

/* What the materials of a block did in a step. */
struct material_outcome {
    bool flowed;       /* plastic strain: strains have to go back to their stored form */
    bool refitted;     /* whole strains were fitted: all of them have to go back */
    bool dissipated;   /* scratch->dissipation holds something */
    size_t fall_backs; /* cells in which a linear fit was not possible */
};

/* Bit set of the materials with particles in a block. */
uint64_t material_stage_present(const struct run *run, const struct particle_block *block);
/* Mass of the slots of a material, else 0; `present` as above. Valid until the next call. */
const real *material_stage_weights(const struct run *run, const struct particle_block *block,
                                   struct block_scratch *scratch, size_t material,
                                   uint64_t present);

/* Reads the kinematics in scratch; writes strain, stress, plastic_strain, dissipation, the history
 * of the particles, and the averaged volumetric parts into the stored strain. */
struct material_outcome material_stage_run(struct run *run, const struct particle_block *block,
                                           struct block_scratch *scratch, double time_step);

/* Strain energy per initial volume of the strains in scratch into energy[slots]. */
void material_stage_energy(const struct run *run, const struct particle_block *block,
                           struct block_scratch *scratch, real *energy);

#endif

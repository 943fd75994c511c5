/* SPDX-License-Identifier: Apache-2.0 */
/* The stages of the second pass for one block; they hand over through scratch. A pass may run them
 * all, block by block, or some: what comes between them sees all blocks at the same stage. Blocks
 * without rows must not be passed. `still` takes the state as it is, at rest. */
#ifndef TALUS_ADVANCE_H
#define TALUS_ADVANCE_H

#include "explicit/run.h"

/* Corrects the particles' velocities, gathers the motion of the step, and turns strains into trial
 * strains: as stored in the particles, and for the materials in scratch. */
void advance_strain(struct run *run, struct block_scratch *scratch, struct particle_block *block,
                    struct tile_sums *sums, bool still);
/* Stress out of the trial strains into scratch, and what it leaves behind in the particles. */
void advance_stress(struct run *run, struct block_scratch *scratch, struct particle_block *block,
                    struct tile_sums *sums, bool still);
/* `first`: scatters the forces of the stress in scratch at the positions that strained. */
void advance_forces(struct run *run, struct block_scratch *scratch, struct particle_block *block,
                    struct tile_sums *sums);
/* `first`: corrects the velocities, gathers the motion of the step, and ends like advance_finish,
 * without forces. */
void advance_move(struct run *run, struct block_scratch *scratch, uint32_t block_index,
                  struct tile *tile, struct tile_sums *sums);
/* Moves the particles by scratch->displacement, sums, puts those that left their cells into the
 * tile's outbox, and scatters the rest. */
void advance_finish(struct run *run, struct block_scratch *scratch, uint32_t block_index,
                    struct tile *tile, struct tile_sums *sums, bool still);

#endif

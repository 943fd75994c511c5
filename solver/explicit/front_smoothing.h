/* SPDX-License-Identifier: Apache-2.0 */
/* Particles at the front of the material, in scenes that smooth it (node_layout.volume). One block
 * at a time; see front_smoothing.c for the method. */
#ifndef TALUS_FRONT_SMOOTHING_H
#define TALUS_FRONT_SMOOTHING_H

#include "explicit/run.h"

/* Before the motion of a step is gathered: which particles of a block reach a marked node, into
 * scratch->mean, and where these fly on, their velocity at the start of the step, into
 * scratch->spin. False if there are none. */
bool front_find(const struct run *run, const struct shape_context *context,
                const struct particle_block *block, struct block_scratch *scratch);
/* After it: what front_find has found gets its own gradient, and displacement where it flies on. */
void front_smooth(const struct run *run, const struct shape_context *context,
                  const struct particle_block *block, struct block_scratch *scratch);

/* volume_i += sum N V of the slots whose mass is not 0, at their new positions. */
void front_scatter(struct run *run, const struct particle_block *block, const real *mass,
                   struct block_scratch *scratch);
/* The same for one particle that has changed blocks. */
void front_scatter_one(struct run *run, const struct particle_block *block, size_t slot);

#endif

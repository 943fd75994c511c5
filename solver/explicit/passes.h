/* SPDX-License-Identifier: Apache-2.0 */
/* Passes over all particle blocks: what one tile does (tiles.c), and how threads share the tiles
 * (passes.c). Tiles of one colour run at the same time, colours one after the other. */
#ifndef TALUS_PASSES_H
#define TALUS_PASSES_H

#include "explicit/run.h"

/* What a pass does with one tile, with the scratch of the thread. */
typedef void pass_tile(struct run *run, size_t tile_index, struct block_scratch *scratch);

/* Fetches the particles of the block two ahead while the one at `entry` is worked on. */
void tile_look_ahead(const struct run *run, size_t entry, struct block_scratch *scratch);
/* Zero but for what is compared. */
void tile_sums_clear(struct tile_sums *sums);
void run_pass(struct run *run, pass_tile *pass);

/* v_p += sum N dv_i; P_i = sum N m_p v_p. */
pass_tile kick_tile;
/* Everything from the nodes' velocities to the forces at the new positions, block by block; the
 * tile's sums start from zero. */
pass_tile advance_tile;
/* `first`: from the nodes' velocities to the forces at the same positions; the tile's sums start
 * from zero. Then, with the velocities after these forces, to the new positions. */
pass_tile stress_tile;
pass_tile move_tile;
/* The same as advance_tile at rest: stress of the initial state, its masses and forces. */
pass_tile start_tile;

#endif

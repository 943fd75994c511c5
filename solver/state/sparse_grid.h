/* SPDX-License-Identifier: Apache-2.0 */
/* The sparse grid: particle blocks where there is material, the node blocks they touch, and the
 * order in which threads may work on them.
 *
 * Tiles: blocks are grouped into tiles one block wide in x and TILE_ROWS cells in y (all of z),
 * with four colours. Tiles of one colour share no node block, so they scatter at the same time
 * without atomics; within a tile and between colours the order is fixed. Hence every node receives
 * its contributions in the same order for any number of threads.
 *
 * Shape functions with a `reach` touch the nodes of that many cells more on every side: then tiles
 * are twice as wide and high, and node blocks may lie that far outside of the domain. */
#ifndef TALUS_SPARSE_GRID_H
#define TALUS_SPARSE_GRID_H

#include "state/domain.h"
#include "state/nodes.h"
#include "state/particles.h"

#include <stdbool.h>

enum { TILE_ROWS = 4, TILE_COLOURS = 4, REACH_MAX = 2 };

struct tile {
    size_t begin, end;   /* into tile_blocks */
    size_t outbox_begin; /* first record of the tile in the outbox */
    size_t outbox_count; /* filled by the second pass */
};

struct sparse_grid {
    struct domain domain;
    struct particle_layout layout;
    uint32_t reach; /* cells, at most REACH_MAX; set before the first block is made */
    struct particle_block *blocks; /* [block_count] owned */
    size_t block_count, block_capacity;
    struct block_map map;
    struct node_blocks nodes;
    struct tile *tiles; /* [tile_count], by colour */
    size_t tile_count, tile_capacity;
    size_t colour_begin[TILE_COLOURS + 1];
    uint32_t *tile_blocks; /* [block_count] */
    size_t tile_block_capacity;
    bool tiles_stale;   /* blocks were added or dropped */
    size_t tiled_count; /* blocks that tile_blocks holds in order */
    uint32_t row_max;   /* largest row_count ever needed by a chunk */
    void *slab;         /* the packed chunks; owned */
    size_t slab_bytes;
    size_t loose_count; /* chunks made since the last packing */
};

void sparse_grid_release(struct sparse_grid *grid);
/* Index of the block that holds a cell (not negative), or BLOCK_NONE. */
uint32_t sparse_grid_find_block(const struct sparse_grid *grid, const int32_t cell[3]);
/* Index of the block that holds a cell, made with its node blocks if missing. BLOCK_NONE without
 * memory. Pointers to blocks and node values are void afterwards. */
uint32_t sparse_grid_require_block(struct sparse_grid *grid, const int32_t cell[3]);
/* Sorts the blocks into tiles if they are stale. 0, or -1 without memory. */
int sparse_grid_update_tiles(struct sparse_grid *grid);
/* Drops blocks without particles and node blocks that no block touches, and sorts both in the order
 * in which the passes walk over them. 0 or -1. */
int sparse_grid_purge(struct sparse_grid *grid);
/* Moves all chunks side by side, in the order of the passes, the first time without slack: memory
 * is then read from front to back. No value changes. Both copies exist for a moment. 0, or -1
 * without memory, and then nothing has changed. */
int sparse_grid_pack(struct sparse_grid *grid);
/* Inserts a particle whose record holds its position relative to `cell`; grows what must grow.
 * Returns the block, with the slot in *slot; BLOCK_NONE without memory. */
uint32_t sparse_grid_insert(struct sparse_grid *grid, const int32_t cell[3],
                            const struct particle_record *record, size_t *slot);
/* World position of a slot of a block [m]; 0 on axes that the domain lacks. */
void sparse_grid_slot_position(const struct sparse_grid *grid, const struct particle_block *block,
                               size_t slot, double position[3]);
/* Bytes held. */
size_t sparse_grid_memory(const struct sparse_grid *grid);
size_t sparse_grid_particle_count(const struct sparse_grid *grid);
size_t sparse_grid_active_cells(const struct sparse_grid *grid);

#endif

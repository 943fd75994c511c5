/* SPDX-License-Identifier: Apache-2.0 */
/* What the passes do with one tile, and the memory that they fetch ahead. */
#include "base/inline.h"
#include "explicit/advance.h"
#include "explicit/passes.h"
#include "explicit/stage_clock.h"

#include <string.h>

/* Blocks between what is fetched and what is worked on: about the time of a memory access. */
enum { FIRST_PASS_AHEAD = 3, SECOND_PASS_AHEAD = 2 };

/* Asks for bytes of memory in the second-level cache. */
TALUS_INLINE void fetch(const void *memory, size_t bytes)
{
    enum { LINE = 64 };
    for (size_t offset = 0; offset < bytes; offset += LINE)
        __builtin_prefetch((const char *)memory + offset, 0, 2);
}

/* The block that comes `distance` after one, in this tile or the next of the colour; or NULL.
 * Fetches the nodes that no block before it touches. */
TALUS_INLINE const struct particle_block *block_ahead(const struct run *run, size_t entry,
                                                      size_t distance)
{
    if (entry + distance >= run->grid.block_count)
        return NULL;
    const struct particle_block *block = &run->grid.blocks[run->grid.tile_blocks[entry + distance]];
    const size_t last = ((size_t)1 << run->grid.domain.axis_count) - 1;
    const size_t bytes = node_block_bytes(&run->grid.nodes);
    fetch(node_values(&run->grid.nodes, block->nodes[last - 1], 0), bytes);
    fetch(node_values(&run->grid.nodes, block->nodes[last], 0), bytes);
    return block;
}

void kick_tile(struct run *run, size_t index, struct block_scratch *scratch)
{
    const struct tile *tile = &run->grid.tiles[index];
    struct stage_clock *clock = scratch->clock;
    const struct shape_context context = run_shape_context(run, run->time_step);
    stage_clock_lap(clock, STAGE_WAIT);
    const uint32_t kicked = run->grid.layout.first_component[PARTICLE_MASS] + 1;
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const struct particle_block *ahead = block_ahead(run, entry, FIRST_PASS_AHEAD);
        if (ahead != NULL)
            fetch(ahead->data, particle_block_bytes(ahead, kicked));
        run->kernels->kick(&context, &run->grid.blocks[run->grid.tile_blocks[entry]]);
    }
    stage_clock_lap(clock, STAGE_FIRST_PASS);
}

void tile_look_ahead(const struct run *run, size_t entry, struct block_scratch *scratch)
{
    const struct particle_block *ahead = block_ahead(run, entry, SECOND_PASS_AHEAD);
    scratch->ahead = (struct fetch_ahead){NULL, NULL};
    if (ahead == NULL)
        return;
    scratch->ahead.next = (const char *)ahead->data;
    scratch->ahead.end =
        (const char *)ahead->data + particle_block_bytes(ahead, run->grid.layout.double_count);
}

void tile_sums_clear(struct tile_sums *sums)
{
    memset(sums, 0, sizeof *sums);
    sums->least_jacobian = 1.0;
    sums->bad_particle = PARTICLE_NONE;
}

static void work_tile(struct run *run, size_t index, struct block_scratch *scratch, bool still)
{
    struct tile *tile = &run->grid.tiles[index];
    struct tile_sums *sums = &run->tile_sums[index];
    stage_clock_lap(scratch->clock, STAGE_WAIT);
    tile_sums_clear(sums);
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const uint32_t block_index = run->grid.tile_blocks[entry];
        struct particle_block *block = &run->grid.blocks[block_index];
        tile_look_ahead(run, entry, scratch);
        if (block->row_count == 0)
            continue;
        advance_strain(run, scratch, block, sums, still);
        advance_stress(run, scratch, block, sums, still);
        advance_finish(run, scratch, block_index, tile, sums, still);
    }
    stage_clock_lap(scratch->clock, STAGE_SECOND_PASS);
}

void stress_tile(struct run *run, size_t index, struct block_scratch *scratch)
{
    const struct tile *tile = &run->grid.tiles[index];
    struct tile_sums *sums = &run->tile_sums[index];
    stage_clock_lap(scratch->clock, STAGE_WAIT);
    tile_sums_clear(sums);
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        struct particle_block *block = &run->grid.blocks[run->grid.tile_blocks[entry]];
        tile_look_ahead(run, entry, scratch);
        if (block->row_count == 0)
            continue;
        advance_strain(run, scratch, block, sums, false);
        advance_stress(run, scratch, block, sums, false);
        advance_forces(run, scratch, block, sums);
    }
    stage_clock_lap(scratch->clock, STAGE_FIRST_PASS);
}

void move_tile(struct run *run, size_t index, struct block_scratch *scratch)
{
    struct tile *tile = &run->grid.tiles[index];
    stage_clock_lap(scratch->clock, STAGE_WAIT);
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const uint32_t block_index = run->grid.tile_blocks[entry];
        tile_look_ahead(run, entry, scratch);
        if (run->grid.blocks[block_index].row_count > 0)
            advance_move(run, scratch, block_index, tile, &run->tile_sums[index]);
    }
    stage_clock_lap(scratch->clock, STAGE_SECOND_PASS);
}

void advance_tile(struct run *run, size_t index, struct block_scratch *scratch)
{
    work_tile(run, index, scratch, false);
}

void start_tile(struct run *run, size_t index, struct block_scratch *scratch)
{
    work_tile(run, index, scratch, true);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Particles that left their cell move to their new block and scatter there, one by one and in a
 * fixed order: by tile, last slot first, so that the slots of the other records stay valid. */
#include "base/inline.h"
#include "explicit/front_smoothing.h"
#include "explicit/out_of_plane.h"
#include "explicit/run.h"
#include "health/health.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Particles between the one that moves and those whose memory is asked for. */
enum { SOURCE_AHEAD = 6, TARGET_AHEAD = 3 };

/* Cell and relative position after the move; false if the particle is outside of the grid. */
static bool rebase(const struct run *run, struct particle_record *record, int32_t cell[3])
{
    const struct domain *domain = &run->grid.domain;
    const uint32_t first = run->grid.layout.first_component[PARTICLE_POSITION];
    bool inside = true;
    assert(domain->axis_count <= 3);
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        const double position = record->values[first + axis];
        const double hop = fmin(fmax(floor(position + 0.5), -2e9), 2e9);
        if (!(hop + cell[axis] >= 0 && hop + cell[axis] < domain->cell_count[axis])) {
            inside = false;
            continue;
        }
        cell[axis] += (int32_t)hop;
        /* Rounding may leave the particle a last bit beyond the edge of its cell. */
        record->values[first + axis] = (real)fmin(fmax(position - hop, -0.5), 0.5);
    }
    return inside;
}

static void book_eliminated(struct run *run, const struct particle_record *record, bool outside)
{
    const struct particle_layout *layout = &run->grid.layout;
    const double mass = record->values[layout->first_component[PARTICLE_MASS]];
    run->audit.eliminated_mass += mass;
    if (outside)
        run->audit.outside_mass += mass;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        run->audit.eliminated_momentum[axis] +=
            mass * record->values[layout->first_component[PARTICLE_VELOCITY] + axis];
}

static enum talus_status move_record(struct run *run, const struct outbox_record *entry,
                                     struct talus_error *error)
{
    struct particle_block *block = &run->grid.blocks[entry->block];
    struct particle_record *record = &run->carried;
    const size_t lane = entry->slot % LANE_COUNT;
    int32_t cell[3] = {block->cell[0] + (int32_t)lane, block->cell[1], block->cell[2]};
    const enum talus_status status = health_check_crosser(run, block, entry->slot, error);
    if (status != TALUS_OK)
        return status;
    double position[3];
    sparse_grid_slot_position(&run->grid, block, entry->slot, position);
    particle_block_remove(&run->grid.layout, block, entry->slot, record);
    const bool outside = !rebase(run, record, cell);
    if (outside || entry->eliminated) {
        run_book_eliminated_energy(run, record, position);
        book_eliminated(run, record, !entry->eliminated);
        if (entry->eliminated)
            return TALUS_OK;
        return health_check_outside(run, record, position, error);
    }
    size_t slot = 0;
    const uint32_t target = sparse_grid_insert(&run->grid, cell, record, &slot);
    if (target == BLOCK_NONE)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory at step %llu",
                               (unsigned long long)run->step);
    /* What enters a new block scatters before run_find_walls comes to it. */
    if (run->grid.reach > 0 && target >= run->marked_block_count)
        run_find_folds(run, &run->grid.blocks[target]);
    const struct shape_context context = run_shape_context(run, run->time_step);
    run->kernels->scatter_one(&context, &run->grid.blocks[target], slot, entry->force_stress,
                              run->scatters);
    if (run->grid.domain.revolves && run->scatters & SCATTER_FORCE)
        run->audit.hoop_force +=
            hoop_scatter_one(run, &run->grid.blocks[target], slot, entry->force_stress[2]);
    const bool smooths = run->grid.nodes.layout.volume != 0;
    if ((run->force_count > 0 || smooths) && run_reserve_scratch(run) != 0)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory at step %llu",
                               (unsigned long long)run->step);
    if (run->force_count > 0)
        run_scatter_forces_one(run, &run->grid.blocks[target], slot, run->time);
    if (smooths)
        front_scatter_one(run, &run->grid.blocks[target], slot);
    return TALUS_OK;
}

/* Asks for the cache lines of one slot of a block: one for each component. */
TALUS_INLINE void fetch_slot(const struct particle_layout *layout,
                             const struct particle_block *block, size_t slot)
{
    const size_t stride = (size_t)block->row_capacity * LANE_COUNT;
    for (size_t component = 0; component < layout->double_count; component++)
        __builtin_prefetch(block->data + component * stride + slot, 1);
    __builtin_prefetch(block->id + slot, 1);
}

/* A particle that moves touches lines all over memory. Those of its old place are asked for some
 * particles ahead. */
TALUS_INLINE void fetch_source(const struct run *run, const struct outbox_record *entry)
{
    const struct particle_block *block = &run->grid.blocks[entry->block];
    const size_t lane = entry->slot % LANE_COUNT;
    const size_t rows = block->lane_count[lane];
    fetch_slot(&run->grid.layout, block, entry->slot);
    if (rows > 0)
        fetch_slot(&run->grid.layout, block, (rows - 1) * LANE_COUNT + lane);
}

/* Then, with its position at hand, those of its new place and of the nodes there. */
TALUS_INLINE void fetch_target(const struct run *run, const struct outbox_record *entry)
{
    const struct sparse_grid *grid = &run->grid;
    const struct particle_block *block = &grid->blocks[entry->block];
    int32_t cell[3] = {block->cell[0] + (int32_t)(entry->slot % LANE_COUNT), block->cell[1],
                       block->cell[2]};
    assert(grid->domain.axis_count <= 3);
    for (uint32_t axis = 0; axis < grid->domain.axis_count; axis++) {
        const real position =
            particle_values(&grid->layout, block, PARTICLE_POSITION, axis)[entry->slot];
        cell[axis] += position > (real)0.5 ? 1 : position < (real)-0.5 ? -1 : 0;
        if (cell[axis] < 0)
            return;
    }
    const uint32_t target = sparse_grid_find_block(grid, cell);
    if (target == BLOCK_NONE || grid->blocks[target].data == NULL)
        return;
    const struct particle_block *next = &grid->blocks[target];
    const size_t lane = (size_t)(cell[0] - next->cell[0]);
    fetch_slot(&grid->layout, next, (size_t)next->lane_count[lane] * LANE_COUNT + lane);
    for (size_t corner = 0; corner < (size_t)1 << grid->domain.axis_count; corner++) {
        const char *values = (const char *)node_values(&grid->nodes, next->nodes[corner], 0);
        __builtin_prefetch(values, 1);
        __builtin_prefetch(values + 64, 1);
    }
}

/* Drops empty blocks when they are more than a quarter. */
static int purge_if_sparse(struct run *run)
{
    size_t empty = 0;
    for (size_t index = 0; index < run->grid.block_count; index++)
        empty += run->grid.blocks[index].row_count == 0;
    if (4 * empty <= run->grid.block_count || run->grid.block_count < 16)
        return 0;
    if (sparse_grid_purge(&run->grid) != 0)
        return -1;
    run->wall_node_count = 0;
    run->walled_block_count = 0;
    return 0;
}

/* Walls, tiles and scratch of blocks that have come or gone. */
static enum talus_status refresh(struct run *run, struct talus_error *error)
{
    if ((run->grid.tiles_stale && (run_find_walls(run) != 0 || run_prepare_tiles(run) != 0)) ||
        run_reserve_scratch(run) != 0)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory at step %llu",
                               (unsigned long long)run->step);
    return TALUS_OK;
}

/* Puts the particles side by side again when half of the blocks have grown out of their place. */
static int pack_if_scattered(struct run *run)
{
    return 2 * run->grid.loose_count > run->grid.block_count ? sparse_grid_pack(&run->grid) : 0;
}

enum talus_status run_purge(struct run *run, struct talus_error *error)
{
    if (purge_if_sparse(run) != 0)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory at step %llu",
                               (unsigned long long)run->step);
    const enum talus_status status = refresh(run, error);
    if (status == TALUS_OK && pack_if_scattered(run) != 0)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory at step %llu",
                               (unsigned long long)run->step);
    return status;
}

enum talus_status run_rebin(struct run *run, struct talus_error *error)
{
    for (size_t index = 0; index < run->grid.tile_count; index++) {
        const struct tile *tile = &run->grid.tiles[index];
        const struct outbox_record *records = &run->outbox[tile->outbox_begin];
        for (size_t entry = tile->outbox_count; entry-- > 0;) {
            if (entry >= SOURCE_AHEAD)
                fetch_source(run, &records[entry - SOURCE_AHEAD]);
            if (entry >= TARGET_AHEAD)
                fetch_target(run, &records[entry - TARGET_AHEAD]);
            const enum talus_status status = move_record(run, &records[entry], error);
            if (status != TALUS_OK)
                return status;
        }
    }
    return refresh(run, error);
}

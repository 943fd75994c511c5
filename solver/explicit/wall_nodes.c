/* SPDX-License-Identifier: Apache-2.0 */
/* Which nodes have walls, and which blocks touch them. */
#include "explicit/node_passes.h"
#include "state/wide_window.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static int append_wall_nodes(struct run *run, size_t block)
{
    const struct domain *domain = &run->grid.domain;
    const int32_t *place = run->grid.nodes.place[block];
    assert(domain->axis_count >= 1 && domain->axis_count <= 3);
    run->block_walled[block] = false;
    for (int lane = 0; lane < LANE_COUNT; lane++) {
        const int32_t node[3] = {place[0] + lane, place[1], place[2]};
        struct node_faces faces;
        wall_set_node_faces(&run->walls, domain, node, &faces);
        if (faces.count == 0)
            continue;
        if (run->wall_node_count == run->wall_node_capacity) {
            const size_t capacity =
                run->wall_node_capacity == 0 ? 256 : 2 * run->wall_node_capacity;
            struct wall_node *larger = realloc(run->wall_nodes, capacity * sizeof *larger);
            if (larger == NULL)
                return -1;
            run->wall_nodes = larger;
            run->wall_node_capacity = capacity;
        }
        struct wall_node *wall = &run->wall_nodes[run->wall_node_count++];
        memset(wall, 0, sizeof *wall);
        wall->block = (uint32_t)block;
        wall->lane = (uint8_t)lane;
        wall->faces = faces;
        for (size_t axis = 0; axis < domain->axis_count; axis++)
            wall->position[axis] = domain_node_position(domain, axis, node[axis]);
        run->block_walled[block] = true;
    }
    return 0;
}

void run_find_folds(const struct run *run, struct particle_block *block)
{
    memset(block->folds, 0, sizeof block->folds);
    for (int lane = 0; lane < LANE_COUNT; lane++) {
        const int32_t cell[3] = {block->cell[0] + lane, block->cell[1], block->cell[2]};
        const unsigned folds = wall_set_cell_folds(&run->walls, &run->grid.domain, cell);
        for (size_t side = 0; side < sizeof block->folds; side++)
            block->folds[side] |= (uint8_t)((folds >> side & 1) << lane);
    }
}

static void mark_block(struct run *run, struct particle_block *block)
{
    const struct domain *domain = &run->grid.domain;
    const uint32_t *nodes = block->nodes;
    size_t count = (size_t)1 << domain->axis_count;
    if (run->grid.reach > 0) {
        nodes = block->wide_nodes;
        count = (size_t)3 * window_row_count(domain->axis_count, run->grid.reach);
        run_find_folds(run, block);
    }
    block->constrained = false;
    for (size_t index = 0; index < count; index++)
        block->constrained = block->constrained || run->block_walled[nodes[index]];
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        /* One cell more on each side: a particle is tested after it has moved. */
        low[axis] = domain_node_position(domain, axis, block->cell[axis] - 1);
        high[axis] = domain_node_position(domain, axis,
                                          block->cell[axis] + (axis == 0 ? LANE_COUNT : 1) + 1);
    }
    block->eliminates = wall_set_may_eliminate(&run->walls, low, high);
}

int run_find_walls(struct run *run)
{
    struct node_blocks *nodes = &run->grid.nodes;
    if (nodes->count > run->block_walled_capacity) {
        bool *walled = realloc(run->block_walled, nodes->capacity * sizeof *walled);
        if (walled == NULL)
            return -1;
        run->block_walled = walled;
        run->block_walled_capacity = nodes->capacity;
    }
    for (size_t block = run->walled_block_count; block < nodes->count; block++) {
        if (append_wall_nodes(run, block) != 0)
            return -1;
    }
    const size_t chunks = wall_chunk_count(run);
    if (chunks * wall_partial_stride(run) > run->wall_partial_capacity) {
        const size_t capacity = 2 * chunks * wall_partial_stride(run);
        double *partials = realloc(run->wall_partials, capacity * sizeof *partials);
        if (partials == NULL)
            return -1;
        run->wall_partials = partials;
        run->wall_partial_capacity = capacity;
    }
    if (node_chunk_count(run) > run->node_sums_capacity) {
        const size_t capacity = 2 * node_chunk_count(run);
        struct node_sums *sums = realloc(run->node_sums, capacity * sizeof *sums);
        if (sums == NULL)
            return -1;
        run->node_sums = sums;
        run->node_sums_capacity = capacity;
    }
    for (size_t index = run->walled_block_count == 0 ? 0 : run->marked_block_count;
         index < run->grid.block_count; index++)
        mark_block(run, &run->grid.blocks[index]);
    run->marked_block_count = run->grid.block_count;
    run->walled_block_count = nodes->count;
    return 0;
}

int run_prepare_walls(struct run *run)
{
    const uint64_t before = run->walls.change_count;
    wall_set_prepare(&run->walls, &run->scene, &run->grid.domain, run->time, run->time_step);
    if (run->walls.change_count == before)
        return 0;
    run->wall_node_count = 0;
    run->walled_block_count = 0;
    return run_find_walls(run);
}

void run_move_walls(struct run *run)
{
    wall_set_move(&run->walls, &run->scene, &run->grid.domain, run->time_step);
}

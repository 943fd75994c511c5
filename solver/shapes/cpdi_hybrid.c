/* SPDX-License-Identifier: Apache-2.0 */
/* Hybrid CPDI: a particle takes CPDI for a step only where linear functions fail, at the edge of
 * the material: if its domain, scaled, overlaps another cell that holds few particles. Elsewhere it
 * is linear. The choice is made where the particle scatters and stands until it scatters again, so
 * that what it gives and takes in a step fits together. */
#include "shapes/cpdi.h"
#include "state/sparse_grid.h"

#include <math.h>

/* Particles of a cell as they were at the start of the step; cells of the block first. */
static uint32_t particles_of_cell(const struct shape_context *context,
                                  const struct particle_block *block, const int32_t cell[3])
{
    const int32_t lane = cell[0] - block->cell[0];
    if (lane >= 0 && lane < LANE_COUNT && cell[1] == block->cell[1] && cell[2] == block->cell[2])
        return block->lane_count[lane];
    if (context->grid == NULL || cell[0] < 0 || cell[1] < 0 || cell[2] < 0)
        return 0;
    const uint32_t index = sparse_grid_find_block(context->grid, cell);
    return index == BLOCK_NONE ? 0 : context->grid->blocks[index].lane_count[cell[0] % LANE_COUNT];
}

/* A box of cells around a particle. */
struct cell_range {
    int32_t own[3], low[3], high[3];
};

static struct cell_range range_of(const struct shape_context *context,
                                  const struct particle_block *block, size_t axes, size_t slot)
{
    struct cell_range range = {.low = {0, 0, 0}};
    for (size_t axis = 0; axis < 3; axis++) {
        const int32_t cell = block->cell[axis] + (axis == 0 ? (int32_t)(slot % LANE_COUNT) : 0);
        range.own[axis] = range.low[axis] = range.high[axis] = cell;
        if (axis >= axes)
            continue;
        const double place = 0.5 + (double)particle_values(context->particles, block,
                                                           PARTICLE_POSITION, (uint32_t)axis)[slot];
        const double reach =
            context->hybrid_scale * (double)cpdi_reach(context, block, axes, axis, slot);
        range.own[axis] = cell + (int32_t)floor(place);
        range.low[axis] = cell + (int32_t)floor(place - reach);
        range.high[axis] = cell + (int32_t)floor(place + reach);
    }
    return range;
}

static bool meets_edge(const struct shape_context *context, const struct particle_block *block,
                       const struct cell_range *range)
{
    int32_t cell[3];
    for (cell[2] = range->low[2]; cell[2] <= range->high[2]; cell[2]++) {
        for (cell[1] = range->low[1]; cell[1] <= range->high[1]; cell[1]++) {
            for (cell[0] = range->low[0]; cell[0] <= range->high[0]; cell[0]++) {
                const bool own = cell[0] == range->own[0] && cell[1] == range->own[1] &&
                                 cell[2] == range->own[2];
                if (!own && particles_of_cell(context, block, cell) <= context->hybrid_count)
                    return true;
            }
        }
    }
    return false;
}

static void resize(const struct shape_context *context, const struct particle_block *block,
                   struct domain_findings *findings)
{
    const size_t axes = cpdi_axis_count(context);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    real *convected = particle_values(context->particles, block, PARTICLE_CONVECTED, 0);
    cpdi_resize(context, block, findings);
    for (size_t slot = 0; slot < slot_count; slot++) {
        convected[slot] = 0;
        if (block->id[slot] == PARTICLE_NONE)
            continue;
        const struct cell_range range = range_of(context, block, axes, slot);
        convected[slot] = meets_edge(context, block, &range);
    }
}

static const struct shape_domain domain = {
    .component_count = cpdi_component_count,
    .needs_gradient = true,
    .chooses = true,
    .initialise = cpdi_initialise,
    .resize = {resize, resize},
};

const struct shape shape_cpdi_hybrid = {
    .name = "cpdi_hybrid",
    .reference = "Mast 2013, sec. B.2.2",
    .summary = "CPDI at the edge of the material, linear inside: for bodies that pull apart",
    .courant_limit = {1.24, 0.49, 1.24},
    .reach = CPDI_REACH,
    .domain = &domain,
    .locks = true,
    .kernels = {&cpdi_kernels_1, &cpdi_kernels_2, &cpdi_kernels_3},
};

/* SPDX-License-Identifier: Apache-2.0 */
/* Bytes that a simulation holds, and what they will be. */
#include "simulation/simulation_private.h"
#include "state/wide_window.h"

#include <math.h>

/* Packed particles take whole pages of this size (state/sparse_grid.c). */
#define SLAB_STEP 0x1p21

double layout_particle_bytes(const struct particle_layout *layout, size_t number)
{
    return (double)(layout->double_count * number + sizeof(uint32_t) +
                    (layout->has_body ? sizeof(uint16_t) : 0));
}

size_t simulation_memory(const struct talus_simulation *simulation)
{
    const struct run *run = &simulation->run;
    size_t bytes = sizeof *simulation + sparse_grid_memory(&run->grid) +
                   (run->initial_particle_count + 1) * sizeof *run->outbox +
                   run->tile_sums_capacity * sizeof *run->tile_sums +
                   run->wall_node_capacity * sizeof *run->wall_nodes +
                   run->wall_partial_capacity * sizeof *run->wall_partials +
                   run->node_sums_capacity * sizeof *run->node_sums +
                   run->block_walled_capacity * sizeof *run->block_walled;
    for (int thread = 0; thread < run->thread_capacity; thread++)
        bytes += block_scratch_bytes(run->scratch[thread].capacity, sizeof(real));
    for (size_t index = 0; index < run->walls.face_count + run->scene.boundary_count; index++)
        bytes += 4 * run->windows[index].capacity * sizeof(double);
    for (size_t index = 0; index < simulation->blob_count; index++)
        bytes += simulation->blobs[index].bytes;
    return bytes;
}

/* Room for `count` where it starts with `first` and doubles. */
static double doubled(double first, double count)
{
    while (first < count)
        first *= 2;
    return first;
}

/* Node blocks of a body of so many blocks, `width` cells wide if it is a cube. */
static double node_blocks_estimate(const struct run *run, double blocks, double width)
{
    const double axes = (double)run->scene.axis_count, reach = run->grid.reach;
    /* A body of few blocks has a layer of nodes more on its upper sides. */
    if (run->grid.reach == 0)
        return blocks * pow(1 + 1 / width, axes) + 2 * pow(width, axes - 1);
    /* More layers on all sides, which a flat body feels twice as much. */
    const double layers = 1 + 2 * reach;
    return blocks * pow(1 + 2 * layers / width, axes - 1) + 3 * pow(width + layers, axes - 1);
}

double simulation_memory_estimate(const struct run *run, size_t number, double particles,
                                  double cells)
{
    const size_t lane_count = sizeof(lanes) / number;
    const double lanes_of_block = (double)lane_count;
    const double per_particle = layout_particle_bytes(&run->grid.layout, number);
    const double per_node_block = (double)run->grid.nodes.layout.component_count * sizeof(lanes) +
                                  sizeof *run->grid.nodes.place;
    const double axes = (double)run->scene.axis_count;
    if (run->shape->halves_cells)
        cells = fmin(cells * pow(2, axes), fmax(particles, cells));
    const double rows = cells > 0 ? particles / cells : 0;
    const double width = pow(fmax(cells, 1), 1 / axes);
    const double blocks = cells / lanes_of_block * (1 + lanes_of_block / width);
    const double nodes = node_blocks_estimate(run, blocks, width);
    const double neighbours =
        run->grid.reach == 0
            ? 0
            : 3 * sizeof(uint32_t) * window_row_count(run->scene.axis_count, run->grid.reach);
    /* Every cell of a block has room for as many particles as the fullest, an even number. */
    const double slab = per_particle * blocks * lanes_of_block * (rows + 1);
    /* With the slack of block_scratch_reserve. */
    const double scratch =
        (double)block_scratch_bytes(1, number) * (1.5 * (rows + 1) * lanes_of_block + 24);
    return ceil(slab / SLAB_STEP) * SLAB_STEP + particles * sizeof *run->outbox +
           doubled(64, blocks) * (sizeof *run->grid.blocks + sizeof *run->grid.tiles + 60) +
           blocks * neighbours + doubled(256, nodes) * (per_node_block + 36) + scratch +
           sizeof(struct talus_simulation);
}

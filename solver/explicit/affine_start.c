/* SPDX-License-Identifier: Apache-2.0 */
/* Where particles carry the slope of their velocity, they begin with that of the initial velocity
 * field: without it a body that rotates would lose the rotation within its particles at once. */
#include "explicit/passes.h"

static void momentum_tile(struct run *run, size_t index, struct block_scratch *scratch)
{
    const struct tile *tile = &run->grid.tiles[index];
    const struct shape_context context = run_shape_context(run, 0.0);
    (void)scratch;
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const struct particle_block *block = &run->grid.blocks[run->grid.tile_blocks[entry]];
        const struct scatter_source source = {
            .mass = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0)};
        if (block->row_count > 0)
            run->kernels->scatter(&context, block, &source, SCATTER_MOMENTUM);
    }
}

static void affine_tile(struct run *run, size_t index, struct block_scratch *scratch)
{
    const struct tile *tile = &run->grid.tiles[index];
    const struct shape_context context = run_shape_context(run, 0.0);
    for (size_t entry = tile->begin; entry < tile->end; entry++) {
        const struct particle_block *block = &run->grid.blocks[run->grid.tile_blocks[entry]];
        if (block->row_count > 0)
            run->kernels->gather(&context, block, GATHER_AFFINE, scratch);
    }
}

static void scatter_momentum(struct run *run)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    for (size_t block = 0; block < nodes->count; block++) {
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
            lanes_store(node_values(nodes, block, nodes->layout.momentum + axis), lanes_splat(0.0));
    }
    run_pass(run, momentum_tile);
}

void run_start_affine(struct run *run)
{
    scatter_momentum(run);
    run_start_nodes(run);
    run_pass(run, affine_tile);
    if (run->scatters & SCATTER_MOMENTUM)
        scatter_momentum(run);
}

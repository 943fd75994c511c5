/* SPDX-License-Identifier: Apache-2.0 */
/* Front smoothing (Mast 2013): a node is nearly empty where its volume fraction
 * theta_i = sum N_ip V_p / (cell volume, half of it per axis on which a wall cuts the support)
 * is below a threshold. The particles that it reaches are updated with what is known at the start
 * of the step: their velocity gradient is of the nodes' velocity there, or (free flight) they do
 * not strain and move by dt v_p. Velocities change as ever, so momentum does not notice. */
#include "explicit/front_smoothing.h"

#include <math.h>
#include <string.h>

/* Share of the threshold that rounding may take: corners of blocks have 1/4 and 1/8 exactly. */
#define ROUNDING 1e-6

static bool flies(const struct run *run)
{
    return run->scene.solver.front_reading == TALUS_FRONT_FREE_FLIGHT;
}

void run_keep_volume(struct run *run)
{
    struct node_layout *layout = &run->grid.nodes.layout;
    if (run->scene.solver.front_threshold > 0)
        layout->volume = node_layout_extend(layout, 2);
}

/* Whole support over what the walls leave of it: a face cuts along the axis nearest its normal. */
static real share_within(const struct run *run, const struct wall_node *wall)
{
    unsigned cut = 0;
    real whole = 1;
    for (size_t index = 0; index < wall->faces.count; index++) {
        const double *normal = run->walls.faces[wall->faces.face[index]].normal;
        size_t along = 0;
        for (size_t axis = 1; axis < run->grid.domain.axis_count; axis++) {
            if (fabs(normal[axis]) > fabs(normal[along]))
                along = axis;
        }
        if ((cut >> along & 1) == 0)
            whole *= 2;
        cut |= 1u << along;
    }
    return whole;
}

void run_mark_empty_nodes(struct run *run)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    double least = (1 - ROUNDING) * run->scene.solver.front_threshold;
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        least *= run->grid.domain.cell[axis];
    for (size_t index = 0; index < run->wall_node_count; index++) {
        const struct wall_node *wall = &run->wall_nodes[index];
        node_values(nodes, wall->block, nodes->layout.volume)[wall->lane] *=
            share_within(run, wall);
    }
#pragma omp parallel for schedule(static) num_threads(run->threads) if (run->threads > 1)
    for (size_t block = 0; block < nodes->count; block++) {
        real *volume = node_values(nodes, block, nodes->layout.volume);
        real *mark = node_values(nodes, block, nodes->layout.volume + 1);
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            mark[lane] = volume[lane] > 0 && volume[lane] < (real)least;
            volume[lane] = 0;
        }
    }
}

/* v_p of the start of the step: with `modified_last` the particles have had their kick. */
static void keep_velocity(const struct run *run, const struct shape_context *context,
                          const struct particle_block *block, struct block_scratch *scratch)
{
    const size_t axes = run->grid.domain.axis_count;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const struct node_layout *layout = &context->nodes->layout;
    const uint32_t kicks[2] = {layout->kick, layout->passed};
    real *const *kick = scratch->stress; /* no stress there yet */
    for (uint32_t axis = 0; axis < axes; axis++)
        memcpy(scratch->spin[axis],
               particle_values(&run->grid.layout, block, PARTICLE_VELOCITY, axis),
               count * sizeof(real));
    for (size_t index = 0; run_kicks(run) && index < 2 && kicks[index] != 0; index++) {
        run->kernels->gather_values(context, block, axes, kick, kicks[index]);
        for (uint32_t axis = 0; axis < axes; axis++) {
            for (size_t slot = 0; slot < count; slot++)
                scratch->spin[axis][slot] -= kick[axis][slot];
        }
    }
}

bool front_find(const struct run *run, const struct shape_context *context,
                const struct particle_block *block, struct block_scratch *scratch)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    bool any = false;
    run->kernels->gather_values(context, block, 1, &scratch->mean,
                                context->nodes->layout.volume + 1);
    for (size_t slot = 0; slot < count; slot++)
        any = any || scratch->mean[slot] > 0;
    if (any && flies(run))
        keep_velocity(run, context, block, scratch);
    return any;
}

/* The gradient of the nodes' velocity at the start of the step, where a particle is marked. */
static void strain_from_start(const struct run *run, const struct shape_context *context,
                              const struct particle_block *block, struct block_scratch *scratch)
{
    const size_t axes = run->grid.domain.axis_count;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    struct node_blocks nodes = run->grid.nodes;
    struct shape_context at_start = *context;
    struct block_scratch other = *scratch;
    nodes.layout.velocity = nodes.layout.start;
    at_start.nodes = &nodes;
    memcpy(other.gradient, scratch->strain, sizeof scratch->strain); /* no strain there yet */
    memcpy(other.gradient + 6, scratch->rate, 3 * sizeof other.gradient[0]);
    run->kernels->gather(&at_start, block, GATHER_GRADIENT, &other);
    for (size_t index = 0; index < 3 * axes; index++) {
        if (index % 3 >= axes)
            continue;
        for (size_t slot = 0; slot < count; slot++)
            scratch->gradient[index][slot] = scratch->mean[slot] > 0
                                                 ? other.gradient[index][slot]
                                                 : scratch->gradient[index][slot];
    }
}

static void fly_on(const struct run *run, const struct shape_context *context,
                   const struct particle_block *block, struct block_scratch *scratch)
{
    const size_t axes = run->grid.domain.axis_count;
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    for (size_t axis = 0; axis < axes; axis++) {
        for (size_t slot = 0; slot < count; slot++) {
            if (!(scratch->mean[slot] > 0))
                continue;
            scratch->displacement[axis][slot] =
                context->displacement[axis] * scratch->spin[axis][slot];
            for (size_t along = 0; along < axes; along++)
                scratch->gradient[3 * axis + along][slot] = 0;
        }
    }
}

void front_smooth(const struct run *run, const struct shape_context *context,
                  const struct particle_block *block, struct block_scratch *scratch)
{
    if (flies(run))
        fly_on(run, context, block, scratch);
    else
        strain_from_start(run, context, block, scratch);
}

void front_scatter(struct run *run, const struct particle_block *block, const real *mass,
                   struct block_scratch *scratch)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const struct shape_context context = run_shape_context(run, run->time_step);
    const real *volume = particle_values(&run->grid.layout, block, PARTICLE_VOLUME, 0);
    for (size_t slot = 0; slot < count; slot++)
        scratch->weight[slot] = mass[slot] > 0 ? volume[slot] : 0;
    run->kernels->scatter_values(&context, block, scratch->weight, 1, (const real *const[]){NULL},
                                 run->grid.nodes.layout.volume);
}

void front_scatter_one(struct run *run, const struct particle_block *block, size_t slot)
{
    struct block_scratch *scratch = &run->scratch[0];
    memset(scratch->mass, 0, (size_t)block->row_count * LANE_COUNT * sizeof(real));
    scratch->mass[slot] = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0)[slot];
    front_scatter(run, block, scratch->mass, scratch);
}

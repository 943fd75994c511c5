/* SPDX-License-Identifier: Apache-2.0 */
/* What happens at the nodes between the passes over particles: forces to velocity increments,
 * momentum to velocity, walls. Node blocks are independent. */
#include "explicit/node_passes.h"
#include "state/wide_lanes.h"

#include <assert.h>
#include <math.h>
#include <string.h>

double run_force_factor(const struct run *run)
{
    const double ramp = run->scene.solver.force_ramp;
    const double begin = -run->scene.solver.settle_time;
    return ramp > 0 ? fmin(1.0, (run->time - begin + run->time_step) / ramp) : 1.0;
}

/* Nodes of a block that are heavy enough to carry motion, and 1 / mass of these. */
struct inertia {
    lane_mask moves;
    lanes inverse_mass;
};

static struct inertia inertia_of(const struct run *run, size_t block)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const lanes mass = lanes_load(node_values(nodes, block, nodes->layout.mass));
    const lane_mask moves = mass > (real)run->mass_cutoff;
    return (struct inertia){moves, (real)1.0 / lanes_select(moves, mass, lanes_splat((real)1.0))};
}

/* dt (f_int / m + g) of a block along one axis, without walls. */
static lanes whole_increment(const struct run *run, size_t block, const struct inertia *inertia,
                             uint32_t axis, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    lanes force = lanes_load(node_values(nodes, block, nodes->layout.force + axis));
    if (nodes->layout.external != 0)
        force +=
            (real)factor * lanes_load(node_values(nodes, block, nodes->layout.external + axis));
    return (real)run->time_step *
           (force * inertia->inverse_mass + (real)(factor * run->gravity[axis]));
}

static void kick_block(struct run *run, size_t block, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const struct inertia inertia = inertia_of(run, block);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const lanes kick = whole_increment(run, block, &inertia, axis, factor);
        real *momentum = node_values(nodes, block, nodes->layout.momentum + axis);
        lanes_store(node_values(nodes, block, nodes->layout.kick + axis),
                    lanes_keep(inertia.moves, kick));
        if (nodes->layout.start != 0)
            lanes_store(node_values(nodes, block, nodes->layout.start + axis),
                        lanes_keep(inertia.moves, lanes_load(momentum) * inertia.inverse_mass));
        lanes_store(momentum, lanes_splat(0.0));
    }
}

static void hold_back_chunk(struct run *run, size_t chunk, double factor)
{
    const size_t begin = chunk * WALL_CHUNK, end = begin + WALL_CHUNK;
    wall_nodes_hold_back(run, begin, end < run->wall_node_count ? end : run->wall_node_count,
                         factor);
}

/* What is called by all threads of a team shares its loops among them; called by one thread without
 * a team, which libgomp would set up for one thread too and a small step feels, it does them all.
 */
static void kick_nodes(struct run *run, double factor)
{
#pragma omp for schedule(static)
    for (size_t block = 0; block < run->grid.nodes.count; block++)
        kick_block(run, block, factor);
#pragma omp for schedule(static)
    for (size_t chunk = 0; chunk < wall_chunk_count(run); chunk++)
        hold_back_chunk(run, chunk, factor);
}

void run_kick_nodes(struct run *run)
{
    const double factor = run_force_factor(run);
    if (run->threads == 1) {
        kick_nodes(run, factor);
        return;
    }
#pragma omp parallel num_threads(run->threads)
    kick_nodes(run, factor);
}

/* P/m without walls. */
static void start_block(struct run *run, size_t block)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const struct inertia inertia = inertia_of(run, block);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const lanes momentum = lanes_load(node_values(nodes, block, nodes->layout.momentum + axis));
        lanes_store(node_values(nodes, block, nodes->layout.velocity + axis),
                    lanes_keep(inertia.moves, momentum * inertia.inverse_mass));
    }
}

static void start_nodes(struct run *run)
{
#pragma omp for schedule(static)
    for (size_t block = 0; block < run->grid.nodes.count; block++)
        start_block(run, block);
#pragma omp for schedule(static)
    for (size_t chunk = 0; chunk < wall_chunk_count(run); chunk++) {
        const size_t begin = chunk * WALL_CHUNK, end = begin + WALL_CHUNK;
        wall_nodes_start(run, begin, end < run->wall_node_count ? end : run->wall_node_count);
    }
}

void run_start_nodes(struct run *run)
{
    if (run->threads == 1) {
        start_nodes(run);
        return;
    }
#pragma omp parallel num_threads(run->threads)
    start_nodes(run);
}

/* Momentum -> velocity before the walls. Without a kick the velocity before the step is P/m, and
 * the whole increment is the correction, with local damping. */
static void update_block(struct run *run, size_t block, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const bool last = !run_kicks(run);
    const real damping = last ? (real)run->scene.solver.local_damping : 0;
    const struct inertia inertia = inertia_of(run, block);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        real *momentum = node_values(nodes, block, nodes->layout.momentum + axis);
        const lanes whole = whole_increment(run, block, &inertia, axis, factor);
        const lanes start = lanes_load(momentum) * inertia.inverse_mass;
        lanes correction = last ? whole : lanes_splat(0.0);
        if (damping > 0)
            correction += local_brake(damping, start + start + whole, whole);
        correction = lanes_keep(inertia.moves, correction);
        lanes_store(node_values(nodes, block, nodes->layout.correction + axis), correction);
        lanes_store(momentum, lanes_splat(0.0)); /* may be the place of the velocity */
        const lanes velocity = lanes_keep(inertia.moves, start) + correction;
        lanes_store(node_values(nodes, block, nodes->layout.velocity + axis), velocity);
        if (last && nodes->layout.start != 0)
            lanes_store(node_values(nodes, block, nodes->layout.start + axis),
                        lanes_keep(inertia.moves, start));
    }
}

static void clear_scattered(struct run *run, size_t block)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    lanes_store(node_values(nodes, block, nodes->layout.mass), lanes_splat(0.0));
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        lanes_store(node_values(nodes, block, nodes->layout.force + axis), lanes_splat(0.0));
        if (nodes->layout.external != 0)
            lanes_store(node_values(nodes, block, nodes->layout.external + axis), lanes_splat(0.0));
    }
}

/* Free nodes of a chunk of blocks, and their sums. What the walls need of a block stays until they
 * have passed. */
static void update_chunk(struct run *run, size_t chunk, double factor, bool clears)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const size_t begin = chunk * NODE_CHUNK;
    const bool damped = run->scene.solver.local_damping > 0;
    struct node_sums *sums = &run->node_sums[chunk];
    wide_lanes mass_sum = {0};
    memset(sums, 0, sizeof *sums);
    for (size_t block = begin; block < begin + NODE_CHUNK && block < nodes->count; block++) {
        const lanes mass = lanes_load(node_values(nodes, block, nodes->layout.mass));
        mass_sum += lanes_widen(lanes_keep(mass > (real)run->mass_cutoff, mass));
        update_block(run, block, factor);
        if (damped)
            local_damping_sum(run, block, factor, sums);
        if (clears && !run->block_walled[block])
            clear_scattered(run, block);
    }
    sums->mass = wide_lanes_sum(mass_sum);
}

/* Gravity and local damping act at every node: their impulses, for the audit. */
static void book_body_forces(struct run *run, double factor)
{
    struct node_sums total = {.mass = 0};
    assert(run->grid.domain.axis_count <= 3);
    for (size_t chunk = 0; chunk < node_chunk_count(run); chunk++) {
        total.mass += run->node_sums[chunk].mass;
        total.damping_energy += run->node_sums[chunk].damping_energy;
        for (size_t axis = 0; axis < 3; axis++)
            total.damping_impulse[axis] += run->node_sums[chunk].damping_impulse[axis];
    }
    double square = 0;
    for (size_t axis = 0; axis < 3; axis++) {
        const double impulse =
            total.mass * factor * run->gravity[axis] * run->time_step + total.damping_impulse[axis];
        run->audit.impulse[axis] += impulse;
        square += impulse * impulse;
    }
    run->audit.exchanged += sqrt(square);
    run->energy.damping += total.damping_energy;
}

/* Free nodes, then walls; by a team or alone, as kick_nodes. */
static void update_nodes(struct run *run, double factor, bool clears)
{
#pragma omp for schedule(static)
    for (size_t chunk = 0; chunk < node_chunk_count(run); chunk++)
        update_chunk(run, chunk, factor, clears);
#pragma omp for schedule(static)
    for (size_t chunk = 0; chunk < wall_chunk_count(run); chunk++)
        wall_nodes_update(run, chunk, factor);
    if (!start_velocity_blends(run))
        return;
#pragma omp for schedule(static)
    for (size_t block = 0; block < run->grid.nodes.count; block++)
        blend_block(run, block);
}

/* Blocks that the update has not cleared, because the walls or the ramp still needed them. */
static void clear_nodes(struct run *run, bool all)
{
#pragma omp for schedule(static)
    for (size_t block = 0; block < run->grid.nodes.count; block++) {
        if (all || run->block_walled[block])
            clear_scattered(run, block);
    }
}

/* The hoop stress of a body of revolution pulls it towards its axis: a force of its own on the
 * momentum along x. */
static void book_hoop(struct run *run)
{
    const double impulse = run->audit.hoop_force * run->time_step;
    run->audit.impulse[0] += impulse;
    run->audit.exchanged += fabs(impulse);
}

static void book_nodes(struct run *run, double factor)
{
    book_body_forces(run, factor);
    book_hoop(run);
    wall_nodes_sum(run);
    if (factor < 1 || run->gravity_deviates)
        run_book_gravity(run, factor);
    if (run->force_count > 0)
        run_book_forces(run, factor);
}

void run_update_nodes(struct run *run)
{
    const double factor = run_force_factor(run);
    /* Then masses or external forces are still needed after the walls. */
    const bool kept = factor < 1 || run->gravity_deviates || run->force_count > 0;
    if (run->threads == 1) {
        update_nodes(run, factor, !kept);
        book_nodes(run, factor);
        clear_nodes(run, kept);
        return;
    }
#pragma omp parallel num_threads(run->threads)
    {
        update_nodes(run, factor, !kept);
#pragma omp single
        book_nodes(run, factor);
        clear_nodes(run, kept);
    }
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Forces on particles other than stress and constant gravity: each particle gives sum N m a to its
 * nodes beside its stress, at the same place and time, and the nodes move by both. They are kept
 * apart at the nodes, because the force ramp acts on them only and their work has to be booked. */
#include "explicit/run.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static void add_body_force(const void *source, const struct run *run,
                           const struct particle_block *block, size_t begin, size_t end,
                           double time, real *const acceleration[3])
{
    const struct run_callbacks *callbacks = source;
    for (size_t slot = begin; slot < end; slot++) {
        double position[3], out[3] = {0, 0, 0};
        if (block->id[slot] == PARTICLE_NONE)
            continue;
        sparse_grid_slot_position(&run->grid, block, slot, position);
        callbacks->body_force(callbacks->context, block->id[slot], position, time, out);
        for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++)
            acceleration[axis][slot] += (real)out[axis];
    }
}

void run_add_force(struct run *run, struct particle_force force)
{
    assert(run->force_count < PARTICLE_FORCE_MAX && run->grid.nodes.count == 0);
    if (run->force_count == 0)
        run->grid.nodes.layout.external =
            node_layout_extend(&run->grid.nodes.layout, run->grid.domain.axis_count);
    run->forces[run->force_count++] = force;
}

void run_set_callbacks(struct run *run, const struct talus_simulation_options *options)
{
    run->callbacks = (struct run_callbacks){.body_force = options->body_force,
                                            .initial_velocity = options->initial_velocity,
                                            .context = options->context};
    if (options->body_force != NULL)
        run_add_force(run, (struct particle_force){add_body_force, &run->callbacks});
}

void run_scatter_forces(struct run *run, const struct particle_block *block, const real *mass,
                        size_t begin, size_t end, struct block_scratch *scratch, double time)
{
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    const struct shape_context context = run_shape_context(run, run->time_step);
    real *const *acceleration = scratch->displacement; /* the particles have moved by it */
    for (size_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        memset(acceleration[axis], 0, count * sizeof(real));
    for (size_t index = 0; index < run->force_count; index++)
        run->forces[index].add(run->forces[index].source, run, block, begin, end, time,
                               acceleration);
    run->kernels->scatter_values(&context, block, mass, run->grid.domain.axis_count,
                                 (const real *const *)acceleration,
                                 run->grid.nodes.layout.external);
}

void run_scatter_forces_one(struct run *run, const struct particle_block *block, size_t slot,
                            double time)
{
    struct block_scratch *scratch = &run->scratch[0];
    memset(scratch->mass, 0, (size_t)block->row_count * LANE_COUNT * sizeof(real));
    scratch->mass[slot] = particle_values(&run->grid.layout, block, PARTICLE_MASS, 0)[slot];
    run_scatter_forces(run, block, scratch->mass, slot, slot + 1, scratch, time);
}

void run_book_forces(struct run *run, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    double impulse[3] = {0, 0, 0}, work = 0;
    for (size_t block = 0; block < nodes->count; block++) {
        const real *mass = node_values(nodes, block, nodes->layout.mass);
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
            const real *force = node_values(nodes, block, nodes->layout.external + axis);
            const real *velocity = node_values(nodes, block, nodes->layout.velocity + axis);
            for (size_t lane = 0; lane < LANE_COUNT; lane++) {
                if (mass[lane] <= run->mass_cutoff)
                    continue;
                const double given = factor * (double)force[lane] * run->time_step;
                impulse[axis] += given;
                work += given * (double)velocity[lane];
            }
        }
    }
    for (size_t axis = 0; axis < 3; axis++)
        run->audit.impulse[axis] += impulse[axis];
    run->audit.exchanged +=
        sqrt(impulse[0] * impulse[0] + impulse[1] * impulse[1] + impulse[2] * impulse[2]);
    run->energy.external += work;
    run->energy.exchanged += fabs(work);
}

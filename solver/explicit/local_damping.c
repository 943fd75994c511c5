/* SPDX-License-Identifier: Apache-2.0 */
/* Local damping (Cundall 1982): every node is braked by a share of the force on it, against its
 * motion.
 *
 * A brake b takes the work - b m (v0 + v1) / 2 of a step that leads from v0 to v1: that is exact
 * for the energy that an undamped step of a linear material keeps, kinetic + strain + dt/2 f . v.
 * So a brake must oppose the velocity in the middle of the step; against that at either end it
 * pushes nodes on that turn within the step. And the material must strain with what the particles
 * have taken of it: with `modified_last` brakes go through the particles as the forces do, in a
 * pass of their own, since they need to know what has come of the forces. With b = - sign(u) min(a
 * |dt f/m|, |u|/2), u = v0 + (velocity after the forces), the sum of their work is at most - sum m
 * |b| |u| / 4 for every shape without negative weights (lumped masses bound consistent ones). */
#include "explicit/node_passes.h"

#include <math.h>
#include <string.h>

/* Turns the kicks of a block into brakes. */
static void brake_block(struct run *run, size_t block)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const struct node_layout *layout = &nodes->layout;
    const lanes mass = lanes_load(node_values(nodes, block, layout->mass));
    const lane_mask moves = mass > (real)run->mass_cutoff;
    const lanes inverse_mass = (real)1.0 / lanes_select(moves, mass, lanes_splat((real)1.0));
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        real *kick = node_values(nodes, block, layout->kick + axis);
        const lanes passed = lanes_load(kick);
        const lanes after =
            lanes_load(node_values(nodes, block, layout->momentum + axis)) * inverse_mass;
        const lanes start = lanes_load(node_values(nodes, block, layout->start + axis));
        const lanes brake =
            local_brake((real)run->scene.solver.local_damping, start + after, passed);
        lanes_store(node_values(nodes, block, layout->passed + axis), passed);
        lanes_store(kick, lanes_keep(moves, brake));
    }
}

void local_brake_at_wall(const struct run *run, const struct wall_node *wall,
                         const double middle[3], const double gain[3], double brake[3])
{
    struct contact contact = wall_node_contact(run, wall);
    contact.constraints_only = true;
    memcpy(contact.pushed, wall->impulse, sizeof contact.pushed);
    memcpy(contact.free_velocity, middle, sizeof contact.free_velocity);
    memcpy(contact.acceleration_increment, middle, sizeof contact.acceleration_increment);
    contact_solve(&contact);
    double square = 0, along = 0;
    for (size_t axis = 0; axis < 3; axis++) {
        brake[axis] = contact.velocity[axis] - contact.frame[axis];
        square += brake[axis] * brake[axis];
        along += gain[axis] * brake[axis];
    }
    const double share =
        square > 0 ? fmin(1.0, run->scene.solver.local_damping * fabs(along) / square) : 0.0;
    for (size_t axis = 0; axis < 3; axis++)
        brake[axis] *= -share;
}

static void brake_wall_node(struct run *run, const struct wall_node *wall)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const struct node_layout *layout = &nodes->layout;
    const double mass = node_values(nodes, wall->block, layout->mass)[wall->lane];
    double middle[3] = {0, 0, 0}, gain[3] = {0, 0, 0}, brake[3];
    if (mass <= run->mass_cutoff)
        return;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const double momentum =
            node_values(nodes, wall->block, layout->momentum + axis)[wall->lane];
        gain[axis] = node_values(nodes, wall->block, layout->passed + axis)[wall->lane];
        middle[axis] =
            0.5 * (momentum / mass +
                   (double)node_values(nodes, wall->block, layout->start + axis)[wall->lane]);
    }
    local_brake_at_wall(run, wall, middle, gain, brake);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        node_values(nodes, wall->block, layout->kick + axis)[wall->lane] = (real)brake[axis];
}

static void clear_momentum(struct run *run, size_t block)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        lanes_store(node_values(nodes, block, nodes->layout.momentum + axis), lanes_splat(0.0));
}

void run_brake_nodes(struct run *run)
{
#pragma omp parallel num_threads(run->threads) if (run->threads > 1)
    {
#pragma omp for schedule(static)
        for (size_t block = 0; block < run->grid.nodes.count; block++)
            brake_block(run, block);
#pragma omp for schedule(static)
        for (size_t index = 0; index < run->wall_node_count; index++)
            brake_wall_node(run, &run->wall_nodes[index]);
#pragma omp for schedule(static)
        for (size_t block = 0; block < run->grid.nodes.count; block++)
            clear_momentum(run, block);
    }
}

/* Brake of a node along an axis, and its velocity in the middle of the step. */
struct braking {
    double brake, middle;
};

static struct braking braking_at(const struct run *run, size_t block, size_t lane, uint32_t axis,
                                 double mass, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const struct node_layout *layout = &nodes->layout;
    const double velocity = node_values(nodes, block, layout->velocity + axis)[lane];
    if (layout->passed != 0) {
        const double start = node_values(nodes, block, layout->start + axis)[lane];
        return (struct braking){.brake = node_values(nodes, block, layout->kick + axis)[lane],
                                .middle = 0.5 * (start + velocity)};
    }
    const double whole = node_free_increment(run, block, lane, axis, mass, factor);
    const double correction = node_values(nodes, block, layout->correction + axis)[lane];
    return (struct braking){.brake = correction - whole, .middle = velocity - 0.5 * correction};
}

void local_damping_sum(const struct run *run, size_t block, double factor, struct node_sums *sums)
{
    const real *mass = node_values(&run->grid.nodes, block, run->grid.nodes.layout.mass);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        for (size_t lane = 0; lane < LANE_COUNT; lane++) {
            if (mass[lane] <= run->mass_cutoff)
                continue;
            const struct braking braking =
                braking_at(run, block, lane, axis, (double)mass[lane], factor);
            const double impulse = (double)mass[lane] * braking.brake;
            sums->damping_impulse[axis] += impulse;
            sums->damping_energy -= impulse * braking.middle;
        }
    }
}

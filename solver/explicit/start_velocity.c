/* SPDX-License-Identifier: Apache-2.0 */
/* The velocity at the start of the step beside that at its end, for scenes whose material moves or
 * strains with something between them: v_theta = v - (1 - theta) (v - v_start); or of which a part
 * strains with the first alone (front_smoothing.c); or that is braked by its mean over the step
 * (local_damping.c).
 *
 * It is that of the particles before the forces, P_i / m_i. With `modified_last` the second pass of
 * the step before scatters it too. What the forces add at the nodes, dt f_i / m_i, has no bound at
 * nodes of little mass, and the velocity that has come back from the particles minus that is none
 * that anything ever had. */
#include "explicit/node_passes.h"

#include <string.h>

void run_keep_start_velocity(struct run *run)
{
    const struct talus_solver_options *solver = &run->scene.solver;
    struct node_layout *layout = &run->grid.nodes.layout;
    const size_t axes = run->grid.domain.axis_count;
    const bool smooths =
        solver->front_threshold > 0 && solver->front_reading == TALUS_FRONT_START_VELOCITY;
    const bool brakes = run_kicks(run) && solver->local_damping > 0;
    if (!start_velocity_blends(run) && !smooths && !brakes)
        return;
    layout->start = node_layout_extend(layout, axes);
    if (run_kicks(run)) /* momentum outlives it */
        layout->motion = layout->velocity = node_layout_extend(layout, axes);
    if (brakes)
        layout->passed = node_layout_extend(layout, axes);
    if (solver->theta != solver->strain_theta)
        layout->motion = node_layout_extend(layout, axes);
}

void wall_node_keep_start(const struct run *run, const struct wall_node *wall,
                          const struct contact *solved, const double start[3])
{
    const struct node_blocks *nodes = &run->grid.nodes;
    /* What a wall holds at the end of the step it holds at its start. */
    struct contact contact = *solved;
    contact.constraints_only = true;
    memcpy(contact.pushed, wall->impulse, sizeof contact.pushed);
    memcpy(contact.free_velocity, start, sizeof contact.free_velocity);
    memcpy(contact.acceleration_increment, start, sizeof contact.acceleration_increment);
    contact_solve(&contact);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++)
        node_values(nodes, wall->block, nodes->layout.start + axis)[wall->lane] =
            (real)contact.velocity[axis];
}

void blend_block(const struct run *run, size_t block)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    const struct node_layout *layout = &nodes->layout;
    const real moving = (real)(1 - run->scene.solver.theta);
    const real straining = (real)(1 - run->scene.solver.strain_theta);
    for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
        const lanes end = lanes_load(node_values(nodes, block, layout->velocity + axis));
        const lanes change = end - lanes_load(node_values(nodes, block, layout->start + axis));
        lanes_store(node_values(nodes, block, layout->motion + axis), end - moving * change);
        lanes_store(node_values(nodes, block, layout->velocity + axis), end - straining * change);
    }
}

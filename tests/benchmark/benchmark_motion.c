/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_motion.h"

#include <math.h>
#include <string.h>

/* Amplitude over wave speed: some 0.05 % of strain and 0.2 % of a cell a step. */
#define MACH 0.004
#define WAVELENGTH_CELLS 16.0

static void field_at(const struct run *run, const double position[3], double amplitude,
                     double velocity[3])
{
    const size_t axes = run->grid.domain.axis_count;
    const double k = 2.0 * acos(-1.0) / (WAVELENGTH_CELLS * run->grid.domain.cell[0]);
    for (size_t axis = 0; axis < axes; axis++) {
        const double x = k * position[axis], y = k * position[(axis + 1) % axes];
        const double turn = axis % 2 == 0 ? 1.0 : -1.0;
        velocity[axis] = run->scene.bodies[0].velocity[axis] +
                         amplitude * (turn * sin(x) * cos(y) + 0.6 * sin(y + 0.7) + 0.3 * sin(x));
    }
}

static void set_block(const struct run *run, const struct particle_block *block, double amplitude)
{
    const struct domain *domain = &run->grid.domain;
    const struct particle_layout *layout = &run->grid.layout;
    for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
        double position[3], velocity[3] = {0, 0, 0};
        if (block->id[slot] == PARTICLE_NONE)
            continue;
        sparse_grid_slot_position(&run->grid, block, slot, position);
        field_at(run, position, amplitude, velocity);
        for (uint32_t axis = 0; axis < domain->axis_count; axis++)
            particle_values(layout, block, PARTICLE_VELOCITY, axis)[slot] = (real)velocity[axis];
    }
}

/* Starts anew from the present particles. */
static enum talus_status restart(struct run *run, struct talus_error *error)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    memset(nodes->values, 0,
           nodes->count * nodes->layout.component_count * LANE_COUNT * sizeof *nodes->values);
    memset(&run->energy, 0, sizeof run->energy);
    memset(&run->audit, 0, sizeof run->audit);
    run->checked_speed = 0;
    return run_start(run, error);
}

enum talus_status benchmark_set_motion(struct run *run, double sign, struct talus_error *error)
{
    for (size_t index = 0; index < run->grid.block_count; index++)
        set_block(run, &run->grid.blocks[index], sign * MACH * run->materials[0].wave_speed);
    return restart(run, error);
}

enum talus_status benchmark_set_ordering(struct run *run, bool last, double courant,
                                         struct talus_error *error)
{
    struct node_layout *layout = &run->grid.nodes.layout;
    const uint32_t component_count = layout->component_count;
    node_layout_init(layout, run->grid.domain.axis_count, last);
    if (layout->component_count != component_count)
        return talus_error_set(error, TALUS_INTERNAL, "layout", "",
                               "the orderings no longer store as much at the nodes");
    run->scene.solver.stress_update = last ? TALUS_STRESS_LAST : TALUS_STRESS_MODIFIED_LAST;
    run->scene.solver.courant = courant;
    return restart(run, error);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Gravity that varies. The potential energy knows the gravity of the scene: constant, straight
 * down. Over time the nodes feel the present value instead; on slopes particles get the difference
 * as a force of their own. The work of either difference is external. */
#include "explicit/run.h"
#include "state/time_table.h"

#include <assert.h>
#include <math.h>

void run_set_gravity(struct run *run)
{
    /* In the middle of the step: the impulse of a linear piece is exact. */
    time_table_vector(run->scene.gravity_table, run->scene.gravity,
                      run->time + 0.5 * run->time_step, run->gravity);
    run->gravity_deviates = time_table_varies(run->scene.gravity_table, 3);
}

/* The slope that holds at a place, or NULL. */
static const struct talus_slope *slope_at(const struct talus_scene *scene, const double up[3],
                                          const double position[3])
{
    for (size_t index = 0; index < scene->slope_count; index++) {
        const struct talus_slope *slope = &scene->slopes[index];
        double along = 0, square = 0, height = 0;
        for (size_t axis = 0; axis < 3; axis++) {
            const double arm = position[axis] - slope->about[axis];
            along += position[axis] * slope->along[axis];
            square += arm * arm;
            height += arm * up[axis];
        }
        const bool round = isnan(slope->below);
        if (round ? square - height * height > slope->beyond * slope->beyond : along < slope->below)
            return slope;
    }
    return NULL;
}

/* b - g = magnitude (sin(angle) along + (1 - cos(angle)) up) (Mast 2013, eqs. 7.12, 7.20). */
static void add_slopes(const void *source, const struct run *run,
                       const struct particle_block *block, size_t begin, size_t end, double time,
                       real *const acceleration[3])
{
    const double radians_per_degree = 3.14159265358979323846 / 180.0;
    const struct talus_scene *scene = source;
    double up[3], magnitude = 0;
    (void)time;
    const size_t axes = run->grid.domain.axis_count;
    assert(axes <= 3);
    for (size_t axis = 0; axis < 3; axis++)
        magnitude = hypot(magnitude, scene->gravity[axis]);
    for (size_t axis = 0; axis < 3; axis++)
        up[axis] = magnitude > 0 ? -scene->gravity[axis] / magnitude : 0;
    for (size_t slot = begin; slot < end; slot++) {
        double position[3];
        if (block->id[slot] == PARTICLE_NONE)
            continue;
        sparse_grid_slot_position(&run->grid, block, slot, position);
        const struct talus_slope *slope = slope_at(scene, up, position);
        if (slope == NULL)
            continue;
        const double angle = slope->angle_deg * radians_per_degree;
        for (size_t axis = 0; axis < axes; axis++)
            acceleration[axis][slot] +=
                (real)(magnitude * (sin(angle) * slope->along[axis] + (1 - cos(angle)) * up[axis]));
    }
}

void run_add_slopes(struct run *run)
{
    if (run->scene.slope_count > 0)
        run_add_force(run, (struct particle_force){add_slopes, &run->scene});
}

void run_book_gravity(struct run *run, double factor)
{
    const struct node_blocks *nodes = &run->grid.nodes;
    double power = 0;
    for (size_t block = 0; block < nodes->count; block++) {
        const real *mass = node_values(nodes, block, nodes->layout.mass);
        for (uint32_t axis = 0; axis < run->grid.domain.axis_count; axis++) {
            const real *velocity = node_values(nodes, block, nodes->layout.motion + axis);
            const double beyond = factor * run->gravity[axis] - run->scene.gravity[axis];
            for (size_t lane = 0; lane < LANE_COUNT; lane++)
                power += mass[lane] * beyond * velocity[lane];
        }
    }
    run->energy.external += power * run->time_step;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Boundaries over time: which of them act, how fast they move, and the grid lines they act on. */
#include "boundaries/boundary.h"
#include "state/time_table.h"

#include <string.h>

static bool moves(const struct talus_boundary *boundary)
{
    return boundary->prescribed != 0 && !boundary->stays;
}

/* Along grid lines boundaries hop by whole cells, all of their sides at once; an oblique one is
 * found again whenever it has moved by more than counts as "on" a grid line. */
static void snap(struct wall_motion *motion, const struct wall_shape *shape,
                 const struct talus_boundary *boundary, const struct domain *domain)
{
    const bool box = boundary->shape == TALUS_BOUNDARY_BOX;
    const double slack = LINE_TOLERANCE * domain_smallest_cell(domain);
    const double *place = box ? boundary->box_min : boundary->point;
    for (size_t axis = 0; axis < domain->axis_count; axis++) {
        if (!box && shape->axis < 0) {
            if (fabs(motion->moved[axis] - motion->snapped[axis]) > slack)
                motion->snapped[axis] = motion->moved[axis];
            continue;
        }
        if (boundary->shape == TALUS_BOUNDARY_PLANE && shape->axis != (int)axis)
            continue; /* as long as it is wide */
        const int32_t lines = domain_nearest_line(domain, axis, place[axis] + motion->moved[axis]) -
                              domain_nearest_line(domain, axis, place[axis]);
        motion->snapped[axis] = (double)lines * domain->cell[axis];
    }
}

static void set_velocities(struct wall_set *walls, const struct talus_scene *scene, double time)
{
    for (size_t index = 0; index < walls->face_count; index++) {
        struct wall_face *face = &walls->faces[index];
        const struct talus_boundary *boundary = &scene->boundaries[face->boundary_index];
        if (face->moves && time > 0)
            time_table_vector(boundary->velocity_tables, boundary->velocity, time, face->velocity);
        else
            memset(face->velocity, 0, sizeof face->velocity);
    }
}

static bool is_at(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

void wall_set_prepare(struct wall_set *walls, const struct talus_scene *scene,
                      const struct domain *domain, double time, double time_step)
{
    if (!walls->timed)
        return;
    const double middle = time + 0.5 * time_step;
    bool changed = false;
    for (size_t index = 0; index < walls->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        struct wall_shape *shape = &walls->shapes[index];
        const struct wall_motion before = shape->motion;
        snap(&shape->motion, shape, boundary, domain);
        shape->motion.acts =
            !boundary->timed || (boundary->from <= middle && middle < boundary->until);
        if (is_at(before.snapped, shape->motion.snapped) && before.acts == shape->motion.acts)
            continue;
        wall_shape_place(shape, boundary, domain);
        changed = true;
    }
    walls->change_count += changed;
    set_velocities(walls, scene, time + time_step);
}

void wall_set_move(struct wall_set *walls, const struct talus_scene *scene,
                   const struct domain *domain, double time_step)
{
    for (size_t index = 0; index < walls->face_count && walls->timed; index++) {
        const struct wall_face *face = &walls->faces[index];
        const struct talus_boundary *boundary = &scene->boundaries[face->boundary_index];
        struct wall_shape *shape = &walls->shapes[face->boundary_index];
        /* Once per boundary: all faces of one that moves have its velocity. */
        if (shape->first_face != index || !moves(boundary) || !shape->motion.acts)
            continue;
        for (size_t axis = 0; axis < domain->axis_count; axis++)
            shape->motion.moved[axis] += time_step * face->velocity[axis];
        wall_shape_place(shape, boundary, domain);
    }
}

void wall_set_get_motions(const struct wall_set *walls, struct wall_motion *motions)
{
    for (size_t index = 0; index < walls->boundary_count; index++)
        motions[index] = walls->shapes[index].motion;
}

void wall_set_set_motions(struct wall_set *walls, const struct talus_scene *scene,
                          const struct domain *domain, const struct wall_motion *motions)
{
    for (size_t index = 0; index < walls->boundary_count; index++) {
        walls->shapes[index].motion = motions[index];
        wall_shape_place(&walls->shapes[index], &scene->boundaries[index], domain);
    }
    walls->change_count++;
}

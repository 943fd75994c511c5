/* SPDX-License-Identifier: Apache-2.0 */
/* Where particles are relative to boundaries: elimination, and probes that look "on" one. */
#include "boundaries/boundary.h"

#include <assert.h>

static double along(const double axis[3], const double from[3], const double to[3])
{
    return axis[0] * (to[0] - from[0]) + axis[1] * (to[1] - from[1]) + axis[2] * (to[2] - from[2]);
}

static bool within_rectangle(const struct wall_shape *shape, size_t axis_count,
                             const double position[3])
{
    const double *axes[2] = {shape->axis_1, shape->axis_2};
    assert(axis_count <= 3);
    for (size_t index = 0; index + 1 < axis_count; index++) {
        if (fabs(along(axes[index], shape->point, position)) > 0.5 * shape->size[index])
            return false;
    }
    return true;
}

static bool behind(const struct wall_shape *shape, size_t axis_count, const double position[3])
{
    if (shape->kind == TALUS_BOUNDARY_BOX) {
        for (size_t axis = 0; axis < axis_count; axis++) {
            if (position[axis] < shape->box_min[axis] || position[axis] > shape->box_max[axis])
                return false;
        }
        return true;
    }
    if (along(shape->normal, shape->point, position) >= 0)
        return false;
    return shape->kind == TALUS_BOUNDARY_PLANE || within_rectangle(shape, axis_count, position);
}

bool wall_set_eliminates(const struct wall_set *walls, const double position[3], int body_index)
{
    for (size_t index = 0; index < walls->boundary_count; index++) {
        const struct wall_shape *shape = &walls->shapes[index];
        if (shape->eliminates && shape->motion.acts &&
            (shape->body_index < 0 || shape->body_index == body_index) &&
            behind(shape, walls->axis_count, position))
            return true;
    }
    return false;
}

bool wall_set_may_eliminate(const struct wall_set *walls, const double low[3], const double high[3])
{
    for (size_t index = 0; index < walls->boundary_count; index++) {
        const struct wall_shape *shape = &walls->shapes[index];
        if (!shape->eliminates || !shape->motion.acts)
            continue;
        if (shape->kind == TALUS_BOUNDARY_BOX)
            return true;
        /* The corner of the box that lies deepest behind the plane. */
        double corner[3];
        for (size_t axis = 0; axis < 3; axis++)
            corner[axis] = shape->normal[axis] > 0 ? low[axis] : high[axis];
        if (along(shape->normal, shape->point, corner) < 0)
            return true;
    }
    return false;
}

static double box_distance(const struct wall_shape *shape, size_t axis_count,
                           const double position[3])
{
    double square = 0;
    for (size_t axis = 0; axis < axis_count; axis++) {
        const double outside = fmax(
            0, fmax(shape->box_min[axis] - position[axis], position[axis] - shape->box_max[axis]));
        square += outside * outside;
    }
    return sqrt(square);
}

double wall_set_distance(const struct wall_set *walls, size_t boundary_index,
                         const double position[3])
{
    const struct wall_shape *shape = &walls->shapes[boundary_index];
    if (shape->kind == TALUS_BOUNDARY_BOX)
        return box_distance(shape, walls->axis_count, position);
    if (shape->kind == TALUS_BOUNDARY_FACE && !within_rectangle(shape, walls->axis_count, position))
        return INFINITY;
    return fabs(along(shape->normal, shape->point, position));
}

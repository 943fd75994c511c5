/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_shape.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static const double surface_tolerance = 1e-10;

/* Unit axis of a cylinder; returns its length [m]. */
static double cylinder_axis(const struct talus_body *body, double axis[3])
{
    double length = 0.0;
    for (int k = 0; k < 3; k++)
        length = hypot(length, body->to[k] - body->from[k]);
    for (int k = 0; k < 3; k++)
        axis[k] = (body->to[k] - body->from[k]) / length;
    return length;
}

static void bound_body(const struct talus_body *body, size_t axis_count, double min[3],
                       double max[3])
{
    double axis[3] = {0.0, 0.0, 0.0};
    assert(axis_count <= 3);
    if (body->shape == TALUS_BODY_CYLINDER)
        (void)cylinder_axis(body, axis);
    for (size_t k = 0; k < axis_count; k++) {
        if (body->shape == TALUS_BODY_BOX) {
            min[k] = body->box_min[k];
            max[k] = body->box_max[k];
        } else if (body->shape == TALUS_BODY_SPHERE) {
            min[k] = body->centre[k] - body->radius;
            max[k] = body->centre[k] + body->radius;
        } else {
            double half = body->radius * sqrt(fmax(0.0, 1.0 - axis[k] * axis[k]));
            min[k] = fmin(body->from[k], body->to[k]) - half;
            max[k] = fmax(body->from[k], body->to[k]) + half;
        }
    }
}

void seeding_shape_init(struct seeding_shape *shape, const struct talus_scene *scene,
                        const struct talus_body *body)
{
    memset(shape, 0, sizeof *shape);
    shape->body = body;
    shape->axis_count = scene->axis_count;
    bound_body(body, scene->axis_count, shape->min, shape->max);
    seeding_shape_cut(shape, body->clip_min, body->clip_max);
}

void seeding_shape_cut(struct seeding_shape *shape, const double min[3], const double max[3])
{
    for (size_t k = 0; k < shape->axis_count; k++) {
        shape->clipped |= min[k] > shape->min[k] || max[k] < shape->max[k];
        shape->min[k] = fmax(shape->min[k], min[k]);
        shape->max[k] = fmin(shape->max[k], max[k]);
    }
}

bool seeding_shape_is_empty(const struct seeding_shape *shape)
{
    for (size_t k = 0; k < shape->axis_count; k++) {
        if (!(shape->max[k] > shape->min[k]))
            return true;
    }
    return false;
}

/* Cuts the interval, given as offsets from the point, with {t: a t^2 + 2 b t + c <= 0}, a >= 0. */
static bool cut_quadratic(double a, double b, double c, double offset[2])
{
    if (a < 1e-14) /* the line runs along the axis of the cylinder */
        return c <= 0.0;
    double discriminant = b * b - a * c;
    if (discriminant < 0.0)
        return false;
    double half = sqrt(discriminant) / a;
    offset[0] = fmax(offset[0], -b / a - half);
    offset[1] = fmin(offset[1], -b / a + half);
    return offset[0] <= offset[1];
}

static bool cut_sphere(const struct seeding_shape *shape, const double point[3], size_t axis,
                       double offset[2])
{
    const struct talus_body *body = shape->body;
    double radius = body->radius * (1.0 + surface_tolerance);
    double square = -radius * radius;
    for (size_t k = 0; k < shape->axis_count; k++)
        square += (point[k] - body->centre[k]) * (point[k] - body->centre[k]);
    return cut_quadratic(1.0, point[axis] - body->centre[axis], square, offset);
}

static bool cut_cylinder(const struct seeding_shape *shape, const double point[3], size_t axis,
                         double offset[2])
{
    const struct talus_body *body = shape->body;
    double direction[3];
    double length = cylinder_axis(body, direction);
    double along = 0.0, square = 0.0;
    for (size_t k = 0; k < 3; k++) {
        double distance = point[k] - body->from[k];
        along += distance * direction[k];
        square += distance * distance;
    }
    double slack = surface_tolerance * body->radius;
    double slope = direction[axis];
    if (fabs(slope) < 1e-14) {
        if (along < -slack || along > length + slack)
            return false;
    } else {
        double first = (-slack - along) / slope, second = (length + slack - along) / slope;
        offset[0] = fmax(offset[0], fmin(first, second));
        offset[1] = fmin(offset[1], fmax(first, second));
    }
    double radius = body->radius * (1.0 + surface_tolerance);
    return cut_quadratic(1.0 - slope * slope, point[axis] - body->from[axis] - along * slope,
                         square - along * along - radius * radius, offset) &&
           offset[0] <= offset[1];
}

bool seeding_shape_interval(const struct seeding_shape *shape, const double point[3],
                            enum talus_axis axis, double interval[2])
{
    size_t along = (size_t)axis;
    for (size_t k = 0; k < shape->axis_count; k++) {
        if (k != along && (point[k] < shape->min[k] || point[k] > shape->max[k]))
            return false;
    }
    double offset[2] = {shape->min[along] - point[along], shape->max[along] - point[along]};
    bool inside = offset[0] <= offset[1];
    if (inside && shape->body->shape == TALUS_BODY_SPHERE)
        inside = cut_sphere(shape, point, along, offset);
    else if (inside && shape->body->shape == TALUS_BODY_CYLINDER)
        inside = cut_cylinder(shape, point, along, offset);
    interval[0] = point[along] + offset[0];
    interval[1] = point[along] + offset[1];
    return inside;
}

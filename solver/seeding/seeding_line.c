/* SPDX-License-Identifier: Apache-2.0 */
/* What of a line lies in a body. */
#include "seeding/seeding_polygon.h"
#include "seeding/seeding_shape.h"

#include <math.h>
#include <string.h>

static const double surface_tolerance = 1e-10;

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

static bool cut_sphere(const struct seeding_shape *shape, const double point[3],
                       const double direction[3], double offset[2])
{
    const struct talus_body *body = shape->body;
    double radius = body->radius * (1.0 + surface_tolerance);
    double square = -radius * radius, along = 0.0;
    for (size_t k = 0; k < shape->axis_count; k++) {
        square += (point[k] - body->centre[k]) * (point[k] - body->centre[k]);
        along += (point[k] - body->centre[k]) * direction[k];
    }
    return cut_quadratic(1.0, along, square, offset);
}

static bool cut_cylinder(const struct seeding_shape *shape, const double point[3],
                         const double direction[3], double offset[2])
{
    const struct talus_body *body = shape->body;
    double axis[3];
    double length = seeding_cylinder_axis(body, axis);
    double along = 0.0, square = 0.0, slope = 0.0, ahead = 0.0;
    for (size_t k = 0; k < 3; k++) {
        double distance = point[k] - body->from[k];
        along += distance * axis[k];
        square += distance * distance;
        slope += direction[k] * axis[k];
        ahead += distance * direction[k];
    }
    double slack = surface_tolerance * body->radius;
    if (fabs(slope) < 1e-14) {
        if (along < -slack || along > length + slack)
            return false;
    } else {
        double first = (-slack - along) / slope, second = (length + slack - along) / slope;
        offset[0] = fmax(offset[0], fmin(first, second));
        offset[1] = fmin(offset[1], fmax(first, second));
    }
    double radius = body->radius * (1.0 + surface_tolerance);
    return cut_quadratic(1.0 - slope * slope, ahead - along * slope,
                         square - along * along - radius * radius, offset) &&
           offset[0] <= offset[1];
}

/* The part of the line in the bounding box; false if there is none. */
static bool cut_box(const struct seeding_shape *shape, const double point[3],
                    const double direction[3], double offset[2])
{
    offset[0] = -INFINITY;
    offset[1] = INFINITY;
    for (size_t k = 0; k < shape->axis_count; k++) {
        if (fabs(direction[k]) < 1e-14) {
            if (point[k] < shape->min[k] || point[k] > shape->max[k])
                return false;
            continue;
        }
        const double first = (shape->min[k] - point[k]) / direction[k];
        const double second = (shape->max[k] - point[k]) / direction[k];
        offset[0] = fmax(offset[0], fmin(first, second));
        offset[1] = fmin(offset[1], fmax(first, second));
    }
    return offset[0] <= offset[1];
}

/* All parts of a polygon on the line that lie in the interval. */
static void cut_polygon(const struct seeding_shape *shape, const double point[3],
                        const double direction[3], const double interval[2],
                        struct seeding_line *line)
{
    double crossing[SEEDING_VERTEX_MAX];
    const struct talus_body *body = shape->body;
    const size_t count =
        polygon_crossings(body->vertices, body->vertex_count, point, direction, crossing);
    for (size_t k = 0; k + 1 < count; k += 2) {
        const double begin = fmax(crossing[k], interval[0]);
        const double end = fmin(crossing[k + 1], interval[1]);
        if (begin > end)
            continue;
        line->offset[line->count][0] = begin;
        line->offset[line->count++][1] = end;
    }
}

void seeding_shape_line(const struct seeding_shape *shape, const double point[3],
                        const double direction[3], struct seeding_line *line)
{
    double offset[2];
    const enum talus_body_shape kind = shape->body->shape;
    line->count = 0;
    if (!cut_box(shape, point, direction, offset))
        return;
    if (kind == TALUS_BODY_POLYGON) {
        cut_polygon(shape, point, direction, offset, line);
        return;
    }
    if ((kind == TALUS_BODY_SPHERE && !cut_sphere(shape, point, direction, offset)) ||
        (kind == TALUS_BODY_CYLINDER && !cut_cylinder(shape, point, direction, offset)))
        return;
    line->count = 1;
    memcpy(line->offset[0], offset, sizeof offset);
}

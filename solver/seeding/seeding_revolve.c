/* SPDX-License-Identifier: Apache-2.0 */
/* Bodies of revolution: x is the distance from the axis, and volumes are those of the whole circle
 * (Pappus: area times the way of its centroid). */
#include "seeding/seeding_lattice.h"
#include "seeding/seeding_shape.h"

#include <math.h>

enum { PANEL_COUNT = 16, BISECTION_MAX = 40 };
static const double two_pi = 6.28318530717958647693;

static double radius_of(const struct seeding_shape *shape, double x, double y)
{
    double world[3];
    seeding_shape_to_world(shape, (const double[3]){x, y, 0.0}, world);
    return world[0];
}

/* Integral of the radius over the line at x, in coordinates of the body, that lies in the shape:
 * the radius is linear along it. */
static double moment_at(const struct seeding_shape *shape, double x)
{
    static const double along[3] = {0.0, 1.0, 0.0};
    const double point[3] = {x, shape->min[1], 0.0};
    struct seeding_line line;
    double sum = 0.0;
    seeding_shape_line(shape, point, along, &line);
    for (size_t k = 0; k < line.count; k++) {
        const double *offset = line.offset[k];
        sum +=
            (offset[1] - offset[0]) * radius_of(shape, x, point[1] + 0.5 * (offset[0] + offset[1]));
    }
    return sum;
}

/* Adaptive Simpson rule on one interval whose end and middle values are known. */
static double integrate(const struct seeding_shape *shape, const double x[2], const double value[3],
                        double tolerance, int depth)
{
    const double width = x[1] - x[0], middle = 0.5 * (x[0] + x[1]);
    const double lower = moment_at(shape, x[0] + 0.25 * width);
    const double upper = moment_at(shape, x[0] + 0.75 * width);
    const double whole = width / 6.0 * (value[0] + 4.0 * value[1] + value[2]);
    const double halves =
        width / 12.0 * (value[0] + 4.0 * lower + 2.0 * value[1] + 4.0 * upper + value[2]);
    const double change = (halves - whole) / 15.0;
    if (depth == 0 || fabs(change) <= tolerance)
        return halves + change;
    return integrate(shape, (double[2]){x[0], middle}, (double[3]){value[0], lower, value[1]},
                     0.5 * tolerance, depth - 1) +
           integrate(shape, (double[2]){middle, x[1]}, (double[3]){value[1], upper, value[2]},
                     0.5 * tolerance, depth - 1);
}

/* Of polygons and of what is cut. */
static double integrated_moment(const struct seeding_shape *shape)
{
    const double height = shape->max[1] - shape->min[1];
    const double width = (shape->max[0] - shape->min[0]) / PANEL_COUNT;
    const double scale = width * height * (shape->max[0] - shape->min[0] + height);
    double moment = 0.0;
    for (int panel = 0; panel < PANEL_COUNT; panel++) {
        const double x[2] = {shape->min[0] + panel * width, shape->min[0] + (panel + 1) * width};
        const double value[3] = {moment_at(shape, x[0]), moment_at(shape, 0.5 * (x[0] + x[1])),
                                 moment_at(shape, x[1])};
        moment += integrate(shape, x, value, 1e-11 * scale, BISECTION_MAX);
    }
    return moment;
}

/* Integral of the radius over the shape [m^3]. */
static double first_moment(const struct seeding_shape *shape)
{
    const struct talus_body *body = shape->body;
    if (body->shape == TALUS_BODY_BOX)
        return seeding_shape_measure(shape) * radius_of(shape,
                                                        0.5 * (shape->min[0] + shape->max[0]),
                                                        0.5 * (shape->min[1] + shape->max[1]));
    if (body->shape == TALUS_BODY_SPHERE && !shape->clipped)
        return seeding_shape_measure(shape) * radius_of(shape, body->centre[0], body->centre[1]);
    return integrated_moment(shape);
}

double seeding_shape_volume(const struct seeding_shape *shape)
{
    if (!shape->revolves || seeding_shape_is_empty(shape) ||
        shape->body->shape == TALUS_BODY_POINTS)
        return seeding_shape_measure(shape);
    return two_pi * first_moment(shape);
}

double seeding_circle(const struct seeding_shape *shape, double x)
{
    return shape->revolves && shape->body->shape != TALUS_BODY_POINTS ? two_pi * x : 1.0;
}

double seeding_lattice_circles(const struct seeding_lattice *lattice)
{
    const struct seeding_shape *shape = &lattice->shape;
    double sum = 0.0;
    uint64_t index[3] = {0, 0, 0};
    struct seeding_row row;
    for (index[1] = 0; index[1] < (uint64_t)lattice->count[1]; index[1]++) {
        seeding_lattice_row(lattice, index, &row);
        const double share = ((double)index[1] + 0.5) / lattice->count[1];
        const double y = shape->min[1] + share * (shape->max[1] - shape->min[1]);
        for (size_t range = 0; range < row.count; range++) {
            /* Equally spaced points: as many times their middle. */
            const double middle = 0.5 * ((double)row.first[range] + (double)row.end[range]);
            sum += (double)(row.end[range] - row.first[range]) *
                   radius_of(shape, shape->min[0] + middle * lattice->spacing[0], y);
        }
    }
    return two_pi * sum;
}

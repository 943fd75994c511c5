/* SPDX-License-Identifier: Apache-2.0 */
/* Volume of a body: a cut sphere or cylinder is sliced perpendicular to an axis; a slice is a disc
 * cut by a convex polygon, whose area is closed form; the slices are integrated adaptively. */
#include "seeding/seeding_polygon.h"
#include "seeding/seeding_shape.h"

#include <math.h>
#include <string.h>

enum { POLYGON_MAX = 12, BISECTION_MAX = 40 };
static const double pi = 3.14159265358979323846;

struct polygon {
    double u[POLYGON_MAX], v[POLYGON_MAX];
    size_t count;
};

/* Coordinates in which slices are perpendicular to `normal`. */
struct slicing {
    const struct seeding_shape *shape;
    double origin[3];             /* [m] centre of the slice at 0 */
    double normal[3], u[3], v[3]; /* orthonormal */
    double tolerance;             /* [m^3] */
};

/* Keeps the part of a convex polygon where a u + b v <= c (Sutherland-Hodgman). */
static void cut_polygon(struct polygon *polygon, double a, double b, double c)
{
    struct polygon result = {.count = 0};
    for (size_t i = 0; i < polygon->count; i++) {
        size_t j = (i + 1) % polygon->count;
        double here = a * polygon->u[i] + b * polygon->v[i] - c;
        double next = a * polygon->u[j] + b * polygon->v[j] - c;
        if (here <= 0.0 && result.count < POLYGON_MAX) {
            result.u[result.count] = polygon->u[i];
            result.v[result.count++] = polygon->v[i];
        }
        if ((here < 0.0) != (next < 0.0) && here != 0.0 && next != 0.0 &&
            result.count < POLYGON_MAX) {
            double share = here / (here - next);
            result.u[result.count] = polygon->u[i] + share * (polygon->u[j] - polygon->u[i]);
            result.v[result.count++] = polygon->v[i] + share * (polygon->v[j] - polygon->v[i]);
        }
    }
    *polygon = result;
}

static double sector_area(double radius, double u0, double v0, double u1, double v1)
{
    return 0.5 * radius * radius * atan2(u0 * v1 - u1 * v0, u0 * u1 + v0 * v1);
}

/* Signed area of the triangle (origin, p, q) inside the disc about the origin. */
static double wedge_area(double radius, double pu, double pv, double qu, double qv)
{
    double du = qu - pu, dv = qv - pv;
    double a = du * du + dv * dv, b = pu * du + pv * dv;
    double c = pu * pu + pv * pv - radius * radius;
    double discriminant = b * b - a * c;
    if (a == 0.0)
        return 0.0;
    if (discriminant <= 0.0)
        return sector_area(radius, pu, pv, qu, qv);
    double first = (-b - sqrt(discriminant)) / a, second = (-b + sqrt(discriminant)) / a;
    if (first >= 1.0 || second <= 0.0)
        return sector_area(radius, pu, pv, qu, qv);
    first = fmax(first, 0.0);
    second = fmin(second, 1.0);
    double fu = pu + first * du, fv = pv + first * dv;
    double su = pu + second * du, sv = pv + second * dv;
    double area = 0.5 * (fu * sv - su * fv);
    if (first > 0.0)
        area += sector_area(radius, pu, pv, fu, fv);
    if (second < 1.0)
        area += sector_area(radius, su, sv, qu, qv);
    return area;
}

/* Area of the slice at distance `s` along the normal: disc and bounding box. */
static double slice_area(const struct slicing *slicing, double s)
{
    const struct seeding_shape *shape = slicing->shape;
    double radius = shape->body->radius;
    if (shape->body->shape == TALUS_BODY_SPHERE && shape->axis_count == 3)
        radius = sqrt(fmax(0.0, radius * radius - s * s));
    struct polygon polygon = {.u = {-radius, radius, radius, -radius},
                              .v = {-radius, -radius, radius, radius},
                              .count = 4};
    for (size_t k = 0; k < shape->axis_count; k++) {
        double place = slicing->origin[k] + s * slicing->normal[k];
        cut_polygon(&polygon, slicing->u[k], slicing->v[k], shape->max[k] - place);
        cut_polygon(&polygon, -slicing->u[k], -slicing->v[k], place - shape->min[k]);
    }
    double area = 0.0;
    for (size_t i = 0; i < polygon.count; i++) {
        size_t j = (i + 1) % polygon.count;
        area += wedge_area(radius, polygon.u[i], polygon.v[i], polygon.u[j], polygon.v[j]);
    }
    return fmax(area, 0.0);
}

/* Adaptive Simpson rule on one interval whose end and middle values are known. */
static double integrate(const struct slicing *slicing, const double s[2], const double area[3],
                        double tolerance, int depth)
{
    double width = s[1] - s[0], middle = 0.5 * (s[0] + s[1]);
    double lower = slice_area(slicing, s[0] + 0.25 * width);
    double upper = slice_area(slicing, s[0] + 0.75 * width);
    double whole = width / 6.0 * (area[0] + 4.0 * area[1] + area[2]);
    double halves = width / 12.0 * (area[0] + 4.0 * lower + 2.0 * area[1] + 4.0 * upper + area[2]);
    double change = (halves - whole) / 15.0;
    if (depth == 0 || fabs(change) <= tolerance)
        return halves + change;
    return integrate(slicing, (double[2]){s[0], middle}, (double[3]){area[0], lower, area[1]},
                     0.5 * tolerance, depth - 1) +
           integrate(slicing, (double[2]){middle, s[1]}, (double[3]){area[1], upper, area[2]},
                     0.5 * tolerance, depth - 1);
}

/* Slices of a sphere are perpendicular to z; those of a cylinder to its axis. Returns the range. */
static void slicing_init(struct slicing *slicing, const struct seeding_shape *shape,
                         double range[2])
{
    const struct talus_body *body = shape->body;
    memset(slicing, 0, sizeof *slicing);
    slicing->shape = shape;
    slicing->normal[2] = slicing->u[0] = slicing->v[1] = 1.0;
    memcpy(slicing->origin, body->centre, sizeof slicing->origin);
    range[0] = fmax(-body->radius, shape->min[2] - body->centre[2]);
    range[1] = fmin(body->radius, shape->max[2] - body->centre[2]);
    if (body->shape == TALUS_BODY_SPHERE)
        return;
    memcpy(slicing->origin, body->from, sizeof slicing->origin);
    range[0] = 0.0;
    range[1] = seeding_cylinder_axis(body, slicing->normal);
    seeding_perpendicular(slicing->normal, slicing->u, slicing->v);
}

static double cut_volume(const struct seeding_shape *shape)
{
    enum { PANEL_COUNT = 16 }; /* so that a feature between the first sample points is not missed */
    struct slicing slicing;
    double range[2];
    slicing_init(&slicing, shape, range);
    if (shape->axis_count == 2)
        return slice_area(&slicing, 0.0);
    double box = 1.0;
    for (size_t k = 0; k < 3; k++)
        box *= shape->max[k] - shape->min[k];
    double volume = 0.0, width = (range[1] - range[0]) / PANEL_COUNT;
    for (int panel = 0; panel < PANEL_COUNT; panel++) {
        double s[2] = {range[0] + panel * width, range[0] + (panel + 1) * width};
        double area[3] = {slice_area(&slicing, s[0]), slice_area(&slicing, 0.5 * (s[0] + s[1])),
                          slice_area(&slicing, s[1])};
        volume += integrate(&slicing, s, area, 1e-11 * box / PANEL_COUNT, BISECTION_MAX);
    }
    return volume;
}

double seeding_shape_measure(const struct seeding_shape *shape)
{
    const struct talus_body *body = shape->body;
    if (seeding_shape_is_empty(shape))
        return 0.0;
    double volume = 0.0;
    for (size_t k = 0; k < body->point_count && body->shape == TALUS_BODY_POINTS; k++)
        volume += body->point_volumes[k];
    if (body->shape == TALUS_BODY_POINTS)
        return volume;
    if (body->shape == TALUS_BODY_POLYGON)
        return fabs(polygon_area(body->vertices, body->vertex_count, shape->min, shape->max));
    if (body->shape == TALUS_BODY_BOX || shape->axis_count == 1) {
        volume = 1.0;
        for (size_t k = 0; k < shape->axis_count; k++)
            volume *= shape->max[k] - shape->min[k];
        return volume;
    }
    if (shape->clipped)
        return cut_volume(shape);
    double disc = pi * body->radius * body->radius;
    if (body->shape == TALUS_BODY_SPHERE)
        return shape->axis_count == 2 ? disc : 4.0 / 3.0 * disc * body->radius;
    return disc * hypot(hypot(body->to[0] - body->from[0], body->to[1] - body->from[1]),
                        body->to[2] - body->from[2]);
}

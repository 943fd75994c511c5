/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_shape.h"

#include <assert.h>
#include <math.h>
#include <string.h>

double seeding_cylinder_axis(const struct talus_body *body, double axis[3])
{
    double length = 0.0;
    for (int k = 0; k < 3; k++)
        length = hypot(length, body->to[k] - body->from[k]);
    for (int k = 0; k < 3; k++)
        axis[k] = (body->to[k] - body->from[k]) / length;
    return length;
}

void seeding_perpendicular(const double n[3], double u[3], double v[3])
{
    int least = 0;
    for (int k = 1; k < 3; k++) {
        if (fabs(n[k]) < fabs(n[least]))
            least = k;
    }
    const double norm = sqrt(1.0 - n[least] * n[least]);
    for (int k = 0; k < 3; k++)
        u[k] = ((k == least ? 1.0 : 0.0) - n[least] * n[k]) / norm;
    for (int k = 0; k < 3; k++)
        v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
}

static void include(double min[3], double max[3], const double point[3])
{
    for (size_t k = 0; k < 3; k++) {
        min[k] = fmin(min[k], point[k]);
        max[k] = fmax(max[k], point[k]);
    }
}

/* Includes a point of the shape, turned or not. */
static void include_point(const struct seeding_shape *shape, bool world, const double point[3],
                          double min[3], double max[3])
{
    double place[3];
    memcpy(place, point, sizeof place);
    if (world)
        seeding_shape_to_world(shape, point, place);
    include(min, max, place);
}

static void include_corners(const struct seeding_shape *shape, bool world, const double low[3],
                            const double high[3], double min[3], double max[3])
{
    for (unsigned corner = 0; corner < 8; corner++) {
        double point[3];
        for (size_t k = 0; k < 3; k++)
            point[k] = (corner >> k & 1u) != 0 ? high[k] : low[k];
        include_point(shape, world, point, min, max);
    }
}

/* Half the extent of the round part of a sphere or cylinder on each axis. */
static void round_extent(const struct seeding_shape *shape, bool world, double half[3])
{
    const struct talus_body *body = shape->body;
    double along[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 0.0};
    if (body->shape == TALUS_BODY_CYLINDER)
        (void)seeding_cylinder_axis(body, along);
    for (size_t k = 0; k < 3; k++)
        for (size_t l = 0; l < 3; l++)
            axis[k] += (world ? shape->turn[k][l] : (double)(k == l)) * along[l];
    for (size_t k = 0; k < 3; k++)
        half[k] = body->radius * sqrt(fmax(0.0, 1.0 - axis[k] * axis[k]));
}

/* Bounding box of the whole shape, without its clip box. */
static void bound_body(const struct seeding_shape *shape, bool world, double min[3], double max[3])
{
    const struct talus_body *body = shape->body;
    double half[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < 3; k++) {
        min[k] = INFINITY;
        max[k] = -INFINITY;
    }
    if (body->shape == TALUS_BODY_BOX)
        include_corners(shape, world, body->box_min, body->box_max, min, max);
    for (size_t k = 0; k < body->vertex_count && body->shape == TALUS_BODY_POLYGON; k++)
        include_point(shape, world,
                      (double[3]){body->vertices[2 * k], body->vertices[2 * k + 1], 0.0}, min, max);
    for (size_t k = 0; k < body->point_count && body->shape == TALUS_BODY_POINTS; k++)
        include_point(shape, world, body->point_positions + 3 * k, min, max);
    if (body->shape == TALUS_BODY_SPHERE || body->shape == TALUS_BODY_CYLINDER) {
        const bool sphere = body->shape == TALUS_BODY_SPHERE;
        include_point(shape, world, sphere ? body->centre : body->from, min, max);
        include_point(shape, world, sphere ? body->centre : body->to, min, max);
        round_extent(shape, world, half);
    }
    for (size_t k = 0; k < 3; k++) {
        min[k] = k < shape->axis_count ? min[k] - half[k] : 0.0;
        max[k] = k < shape->axis_count ? max[k] + half[k] : 0.0;
    }
}

/* Rodrigues' formula. Sine and cosine of right angles are whole, so that boxes stay boxes. */
static void turn_init(struct seeding_shape *shape)
{
    const double radians = shape->body->rotate_angle_deg * (3.14159265358979323846 / 180.0);
    const double *axis = shape->body->rotate_axis, tiny = 1e-15;
    double sine = sin(radians), cosine = cos(radians);
    if (fabs(sine) < tiny || fabs(cosine) < tiny) {
        sine = round(sine);
        cosine = round(cosine);
    }
    for (size_t k = 0; k < 3; k++) {
        const size_t next = (k + 1) % 3, last = (k + 2) % 3;
        for (size_t l = 0; l < 3; l++)
            shape->turn[k][l] = (1.0 - cosine) * axis[k] * axis[l];
        shape->turn[k][k] += cosine;
        shape->turn[k][next] -= sine * axis[last];
        shape->turn[k][last] += sine * axis[next];
    }
}

void seeding_shape_init(struct seeding_shape *shape, const struct talus_scene *scene,
                        const struct talus_body *body)
{
    memset(shape, 0, sizeof *shape);
    shape->body = body;
    shape->axis_count = scene->axis_count;
    assert(shape->axis_count <= 3);
    shape->turned = body->rotate_angle_deg != 0.0;
    turn_init(shape);
    bound_body(shape, false, shape->min, shape->max);
    seeding_shape_cut(shape, body->clip_min, body->clip_max);
    shape->revolves = scene->dimension == TALUS_AXISYMMETRIC;
    if (shape->revolves && !shape->turned && body->shape == TALUS_BODY_SPHERE) {
        static const double open[3] = {INFINITY, INFINITY, INFINITY};
        static const double axis[3] = {0.0, -INFINITY, -INFINITY};
        seeding_shape_cut(shape, axis, open);
    }
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
    if (shape->body->shape == TALUS_BODY_POINTS)
        return shape->body->point_count == 0;
    for (size_t k = 0; k < shape->axis_count; k++) {
        if (!(shape->max[k] > shape->min[k]))
            return true;
    }
    return false;
}

void seeding_shape_to_world(const struct seeding_shape *shape, const double point[3],
                            double world[3])
{
    const double *about = shape->body->rotate_about;
    for (size_t k = 0; k < 3; k++) {
        world[k] = shape->turned ? about[k] : point[k];
        for (size_t l = 0; l < 3 && shape->turned; l++)
            world[k] += shape->turn[k][l] * (point[l] - about[l]);
    }
}

void seeding_shape_direction(const struct seeding_shape *shape, const double world[3],
                             double direction[3])
{
    for (size_t k = 0; k < 3; k++) {
        direction[k] = shape->turned ? 0.0 : world[k];
        for (size_t l = 0; l < 3 && shape->turned; l++)
            direction[k] += shape->turn[l][k] * world[l];
    }
}

void seeding_shape_from_world(const struct seeding_shape *shape, const double world[3],
                              double point[3])
{
    const double *about = shape->body->rotate_about;
    double arm[3] = {0.0, 0.0, 0.0};
    memcpy(point, world, 3 * sizeof *point);
    if (!shape->turned)
        return;
    for (size_t k = 0; k < 3; k++)
        arm[k] = world[k] - about[k];
    seeding_shape_direction(shape, arm, point);
    for (size_t k = 0; k < 3; k++)
        point[k] += about[k];
}

void seeding_shape_bounds(const struct seeding_shape *shape, double min[3], double max[3])
{
    memcpy(min, shape->min, 3 * sizeof *min);
    memcpy(max, shape->max, 3 * sizeof *max);
    if (!shape->turned)
        return;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    include_corners(shape, true, shape->min, shape->max, low, high);
    bound_body(shape, true, min, max);
    for (size_t k = 0; k < shape->axis_count; k++) {
        min[k] = fmax(min[k], low[k]);
        max[k] = fmin(max[k], high[k]);
    }
}

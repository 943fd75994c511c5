/* SPDX-License-Identifier: Apache-2.0 */
/* Geometry of one body: its shape (box, sphere or disc, cylinder, polygon, points) cut by its clip
 * box, all in the coordinates of the body; then turned as a whole. Lattice rows and depths below
 * the surface follow from the intervals of a line that lie in the shape. Borrows the body; owns
 * nothing. */
#ifndef TALUS_SEEDING_SHAPE_H
#define TALUS_SEEDING_SHAPE_H

#include "talus/scene.h"

#include <stdbool.h>

struct seeding_shape {
    const struct talus_body *body;
    size_t axis_count;
    double min[3], max[3]; /* [m] bounding box of the shape before it is turned, cut by the clip
                              box; 0 beyond the dimension; max <= min on an axis where nothing is
                              left */
    bool clipped;          /* the clip box cuts the bounding box */
    bool turned;           /* `turn` is not the identity */
    double turn[3][3];     /* world = about + turn (point - about) */
    bool revolves;         /* axisymmetric: x is the distance from the axis, which cuts the shape */
};

void seeding_shape_init(struct seeding_shape *shape, const struct talus_scene *scene,
                        const struct talus_body *body);

/* Cuts the shape, before it is turned, with one more box, given by its corners [m]. */
void seeding_shape_cut(struct seeding_shape *shape, const double min[3], const double max[3]);

/* True if the bounding box has no extent on some axis. */
bool seeding_shape_is_empty(const struct seeding_shape *shape);

/* Where a point of the body, as described, lies in the world. */
void seeding_shape_to_world(const struct seeding_shape *shape, const double point[3],
                            double world[3]);
/* A direction of the world in the coordinates of the body, and a point. */
void seeding_shape_direction(const struct seeding_shape *shape, const double world[3],
                             double direction[3]);
void seeding_shape_from_world(const struct seeding_shape *shape, const double world[3],
                              double point[3]);

/* Box of the world [m] that holds the turned shape (its smallest one, unless clipped as well). */
void seeding_shape_bounds(const struct seeding_shape *shape, double min[3], double max[3]);

/* Polygons have at most this many vertices, so that a line has half as many intervals. */
enum { SEEDING_VERTEX_MAX = 1000, SEEDING_INTERVAL_MAX = SEEDING_VERTEX_MAX / 2 + 1 };

struct seeding_line { /* intervals of a line in a shape, as distances [m] from its point, growing */
    size_t count;
    double offset[SEEDING_INTERVAL_MAX][2];
};

/* The parts of the line through `point` along the unit `direction`, in coordinates of the body,
 * that lie in the shape. Round surfaces are taken 1e-10 of the radius larger, so that a lattice
 * point exactly on one is inside whatever the rounding. Not for points. */
void seeding_shape_line(const struct seeding_shape *shape, const double point[3],
                        const double direction[3], struct seeding_line *line);

/* Unit axis of a cylinder; returns its length [m]. */
double seeding_cylinder_axis(const struct talus_body *body, double axis[3]);

/* Unit vectors u, v that with the unit vector n make a right-handed basis. */
void seeding_perpendicular(const double n[3], double u[3], double v[3]);

/* Volume [m^3, m^2 x 1 m, m x 1 m^2]: closed form for everything that is not cut and for polygons,
 * integrated to 1e-11 of the bounding box for a cut sphere or cylinder. */
/* Length, area or volume [m, m^2, m^3]: closed form for everything that is not cut, integrated to
 * 1e-11 of the bounding box for a cut sphere or cylinder. */
double seeding_shape_measure(const struct seeding_shape *shape);
/* Volume [m^3, m^2 x 1 m, m x 1 m^2]: the measure, or in axisymmetric scenes the volume of the
 * whole body of revolution [m^3], as exact. */
double seeding_shape_volume(const struct seeding_shape *shape);
/* Length of the circle that a point at x stands for [m]; 1 where nothing revolves. */
double seeding_circle(const struct seeding_shape *shape, double x);

#endif

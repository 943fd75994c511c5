/* SPDX-License-Identifier: Apache-2.0 */
/* Geometry of one body: its shape (box, sphere or disc, cylinder) cut by its clip box. All of them
 * are convex, so that a line parallel to an axis is inside along one interval: lattice rows and
 * depths below the surface follow from that interval. Borrows the body; owns nothing. */
#ifndef TALUS_SEEDING_SHAPE_H
#define TALUS_SEEDING_SHAPE_H

#include "talus/scene.h"

#include <stdbool.h>

struct seeding_shape {
    const struct talus_body *body;
    size_t axis_count;
    double min[3], max[3]; /* [m] bounding box of the shape, cut by the clip box; 0 beyond the
                              dimension; max <= min on an axis where nothing is left */
    bool clipped;          /* the clip box cuts the bounding box */
};

void seeding_shape_init(struct seeding_shape *shape, const struct talus_scene *scene,
                        const struct talus_body *body);

/* Cuts the shape with one more box, given by its corners [m]. */
void seeding_shape_cut(struct seeding_shape *shape, const double min[3], const double max[3]);

/* True if the bounding box has no extent on some axis. */
bool seeding_shape_is_empty(const struct seeding_shape *shape);

/* The interval [m] of the line through `point` parallel to `axis` that lies in the shape; false if
 * there is none. Round surfaces are taken 1e-10 of the radius larger, so that a lattice point
 * exactly on one is inside whatever the rounding. */
bool seeding_shape_interval(const struct seeding_shape *shape, const double point[3],
                            enum talus_axis axis, double interval[2]);

/* Volume [m^3, m^2 x 1 m, m x 1 m^2]: closed form for everything that is not cut, integrated to
 * 1e-11 of the bounding box for a cut sphere or cylinder. */
double seeding_shape_volume(const struct seeding_shape *shape);

#endif

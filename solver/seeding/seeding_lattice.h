/* SPDX-License-Identifier: Apache-2.0 */
/* The lattice of a body (of a list of points: the points in one row): points evenly spaced over the
 * bounding box of its (cut) shape, half a spacing from the sides; a point is kept if it lies inside
 * the shape. Owns nothing. */
#ifndef TALUS_SEEDING_LATTICE_H
#define TALUS_SEEDING_LATTICE_H

#include "seeding/seeding_shape.h"

#include <stdint.h>

struct seeding_lattice {
    struct seeding_shape shape;
    double count[3];   /* points per axis, whole numbers (as double: no overflow); 1 beyond the
                          dimension */
    double spacing[3]; /* [m]; 1 beyond the dimension */
};

void seeding_lattice_init(struct seeding_lattice *lattice, const struct talus_scene *scene,
                          const struct talus_body *body);

/* Points of the lattice before the shape selects (exact up to 2^53). */
double seeding_lattice_point_count(const struct seeding_lattice *lattice);

/* True if the shape keeps some points and not others. */
bool seeding_lattice_selects(const struct seeding_lattice *lattice);

/* Position [m] of point i, j, k: in the world, and before the body is turned. */
void seeding_lattice_world(const struct seeding_lattice *lattice, const uint64_t index[3],
                           double position[3]);
void seeding_lattice_position(const struct seeding_lattice *lattice, const uint64_t index[3],
                              double position[3]);

/* Points of a row that are inside: growing ranges [first, end) that do not overlap. */
struct seeding_row {
    size_t count;
    uint64_t first[2 * SEEDING_INTERVAL_MAX], end[2 * SEEDING_INTERVAL_MAX];
};

/* Row (index[1], index[2]) along x. Needs point counts that fit 2^53. A side of a polygon on which
 * a row lies belongs to it, whether the material is above or below. */
void seeding_lattice_row(const struct seeding_lattice *lattice, uint64_t index[3],
                         struct seeding_row *row);

/* Number of kept points, row by row: takes about 50 ns a row. */
uint64_t seeding_lattice_kept(const struct seeding_lattice *lattice);

/* Sum of the circles of the kept points of an axisymmetric body [m]. */
double seeding_lattice_circles(const struct seeding_lattice *lattice);

/* Volume of the body over the volume that its kept points stand for. */
double seeding_lattice_factor(const struct seeding_lattice *lattice, uint64_t kept);

#endif

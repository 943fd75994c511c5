/* SPDX-License-Identifier: Apache-2.0 */
/* The lattice of a body: points evenly spaced over the bounding box of its (cut) shape, half a
 * spacing from the sides; a point is kept if it lies inside the shape. Owns nothing. */
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

/* Position [m] of point i, j, k. */
void seeding_lattice_position(const struct seeding_lattice *lattice, const uint64_t index[3],
                              double position[3]);

/* The points [first, end) of row (row[1], row[2]) along x that are inside. Needs point counts that
 * fit 2^53. */
void seeding_lattice_row(const struct seeding_lattice *lattice, uint64_t row[3], uint64_t *first,
                         uint64_t *end);

/* Number of kept points, row by row: takes about 50 ns a row. */
uint64_t seeding_lattice_kept(const struct seeding_lattice *lattice);

/* Volume of the body over the volume that its kept points stand for. */
double seeding_lattice_factor(const struct seeding_lattice *lattice, uint64_t kept);

#endif

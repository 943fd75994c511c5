/* SPDX-License-Identifier: Apache-2.0 */
/* Faces of bodies that can be loaded, cut into small pieces. */
#ifndef TALUS_SEEDING_FACE_H
#define TALUS_SEEDING_FACE_H

#include "seeding/seeding_lattice.h"

/* A piece of a face, in the coordinates of the body: its centre [m], area (m^2; in 2D, also of
 * bodies of revolution, m x 1 m, in 1D m^2) and outward normal. */
struct face_piece {
    double centre[3], normal[3], area;
};

/* Calls `visit` with all pieces of the face (or faces) of a traction; they are about half as wide
 * as the lattice, on a box as wide, and their areas add up to that of the face. */
void seeding_visit_face(const struct seeding_lattice *lattice,
                        const struct talus_traction *traction,
                        void (*visit)(void *context, const struct face_piece *piece),
                        void *context);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Which particles carry the loaded faces of a body. A face is cut into small pieces, and each goes
 * to the particle nearest to it: on a box that is the outermost layer of the lattice with equal
 * shares, and everywhere the shares add up to the area of the face. */
#ifndef TALUS_SEEDING_TRACTION_H
#define TALUS_SEEDING_TRACTION_H

#include "seeding/seeding.h"
#include "seeding/seeding_lattice.h"

/* Writes the areas of a body whose particles begin at `first`. 0, or -1 without memory. */
int seeding_write_tractions(const struct talus_scene *scene, const struct seeding_lattice *lattice,
                            size_t first, struct particle_seed *seed);

#endif

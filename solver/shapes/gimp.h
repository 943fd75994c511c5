/* SPDX-License-Identifier: Apache-2.0 */
/* What both kinds of gimp share. PARTICLE_DOMAIN begins with half the length of a particle along
 * every axis, in cell widths, at most GIMP_HALF_MAX. */
#ifndef TALUS_GIMP_H
#define TALUS_GIMP_H

#include "shapes/shape.h"

/* The four nodes that a particle can reach see all of it up to this length. */
#define GIMP_HALF_MAX 1.0

/* Of 1, 2 and 3 axes. */
extern const struct shape_kernels gimp_kernels_1, gimp_kernels_2, gimp_kernels_3;

#endif

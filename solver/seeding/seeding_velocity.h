/* SPDX-License-Identifier: Apache-2.0 */
/* The velocity of a body at the start, as a field: uniform, rigid rotation, or a bending mode of
 * the clamped-free beam. */
#ifndef TALUS_SEEDING_VELOCITY_H
#define TALUS_SEEDING_VELOCITY_H

#include "talus/scene.h"

/* Root b_n of cosh(b) cos(b) = -1 (n = 1, 2, ...): b_n / L is the wave number of the n-th bending
 * mode of a beam of length L, clamped at one end and free at the other. */
double seeding_beam_root(double mode);

/* Shape of the n-th mode at the share `place` (0: clamp, 1: free end) of the length, 1 at the free
 * end, and its derivative with respect to that share. Exact to rounding for all modes. */
void seeding_beam_shape(double mode, double place, double *shape, double *slope);

/* Velocity [m/s] of the body at a point [m]. A beam mode also moves its cross-sections along the
 * axis, -(distance from the axis) x slope, so that they stay normal to it (Mast 2013, sec. 6.2);
 * before the clamp it is 0, beyond the free end the section there continues as a rigid body. */
void seeding_velocity_at(const struct talus_body *body, const double position[3],
                         double velocity[3]);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Flow along Matsuoka and Nakai's own potential (Mast 2013, sec. 3.7): the surface of the dilation
 * angle, shifted along the hydrostatic axis so that it passes through the stress that is returned.
 *
 * Shifted copies of one cone are the level sets of p + |s| h_G(theta), where 1/h(theta) is |s|/P on
 * the surface: a convex potential of degree one, whose flow depends on the direction of s alone and
 * has the trace 1. The yield surface is p + |s| h_F(theta) = c. With 2 G and the trial's |s| = 1,
 * r = K/(2 G) and the return at the Lode angle theta = theta_tr + tau (all derived here)
 *
 *   cos(tau) - a h_G = N        |s| returned           sin(tau) + a h_G' = 0
 *   p_tr - r a + N h_F = c
 *
 * The last one gives a(tau), the second one then has one root where N > 0: the closest point to the
 * trial in the plane of deviators moves along the flow towards triaxial compression, and p + N h_F
 * falls all the way. If it does not fall to c before N = 0, the return is to the apex. So one
 * bracketed unknown does for the four of the source, and needs no guess and no smaller steps.
 *
 * The shift of the potential is c_G = p + |s| h_G, which grows beyond all bounds as the dilation
 * angle falls to 0: below 1 degree the potential of Drucker and Prager takes over, which is then
 * the same to the square of the angle. */
#ifndef TALUS_MATSUOKA_NAKAI_FLOW_H
#define TALUS_MATSUOKA_NAKAI_FLOW_H

#include "materials/matsuoka_nakai_surface.h"
#include "materials/mobilised.h"

/* A mobilised_potential. Reads invariants of turning. The dilation angle is cut to the friction
 * angle in force, beyond which plastic work would be negative. */
void matsuoka_nakai_flow(const struct mobilised *mobilised, size_t count, const real *yields,
                         const struct mobilised_angles *angles, struct invariants *invariants,
                         struct mobilised_flow *flow);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* The planes of Mohr-Coulomb in the space of principal stresses, six of shear and three of tension,
 * and the returns to every subset of them: what the solver's closed forms are held against. */
#ifndef YIELD_PLANES_H
#define YIELD_PLANES_H

#include <stdbool.h>

enum { SHEAR_PLANES = 6, YIELD_PLANES = SHEAR_PLANES + 3, SUBSETS = 1 << YIELD_PLANES };

struct yield_plane { /* normal . stress <= bound */
    double normal[3], flow[3], bound;
};

struct yield_planes {
    double bulk, shear; /* K, G [Pa] */
    int count;          /* SHEAR_PLANES or YIELD_PLANES */
    struct yield_plane plane[YIELD_PLANES];
};

/* Angles in degrees, the rest in Pa; a tension of INFINITY means no planes of tension. */
struct yield_planes yield_planes_of(double bulk, double shear, double friction_deg,
                                    double dilation_deg, double cohesion, double tension);

/* Stress [Pa] beyond the plane that it violates most; negative inside. */
double yield_planes_excess(const struct yield_planes *planes, const double stress[3]);

/* trial - C (sum of flows x multipliers) on all planes of a subset (a bit each, at most three);
 * false if they do not meet in one way. */
bool yield_planes_return_to(const struct yield_planes *planes, unsigned subset,
                            const double trial[3], double stress[3], double multipliers[3]);

/* Returns a stress to the subset whose multipliers are not negative and that leaves it least
 * outside the others; false if it was inside. */
bool yield_planes_return(const struct yield_planes *planes, double stress[3]);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Drucker-Prager cones |s| + rho I1 = mu matched to Mohr-Coulomb's friction angle and cohesion
 * (Mast 2013, eq. 3.106-3.109, whose sigma_Y in 3.107 is the cohesion; the plane strain cones are
 * those of Chen and Mizuno 1990). Angles in radians. */
#ifndef TALUS_CONE_H
#define TALUS_CONE_H

#include <stdbool.h>

enum cone_fit {
    CONE_FIT_OUTER,                   /* compression corners */
    CONE_FIT_INNER,                   /* extension corners */
    CONE_FIT_PLANE_STRAIN,            /* no dilation */
    CONE_FIT_PLANE_STRAIN_ASSOCIATED, /* dilation angle = friction angle */
};

/* rho(angle) [-] */
double cone_slope(enum cone_fit fit, double angle);
/* mu(angle, cohesion [Pa]) [Pa] */
double cone_strength(enum cone_fit fit, double angle, double cohesion);
/* Steepest slope that the fit can have (an angle of 90 degrees). */
double cone_slope_limit(enum cone_fit fit);
/* The angle of a slope below the limit: the inverse of cone_slope. */
double cone_angle(enum cone_fit fit, double slope);

#endif

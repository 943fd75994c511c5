/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/cone.h"

#include <math.h>

/* Every fit is rho = numerator sin(angle), mu = 3 numerator cohesion cos(angle): at the apex
 * mu / rho = 3 cohesion / tan(angle) in all of them. */
static double cone_numerator(enum cone_fit fit, double angle)
{
    double sine = sin(angle);
    switch (fit) {
    case CONE_FIT_OUTER:
        return sqrt(2.0 / 3.0) * 2.0 / (3.0 - sine);
    case CONE_FIT_INNER:
        return sqrt(2.0 / 3.0) * 2.0 / (3.0 + sine);
    case CONE_FIT_PLANE_STRAIN:
        return sqrt(2.0) / 3.0;
    case CONE_FIT_PLANE_STRAIN_ASSOCIATED:
        break;
    }
    /* sqrt(2) tan / sqrt(9 + 12 tan^2) with tan = sin / cos */
    return sqrt(2.0) / sqrt(9.0 + 3.0 * sine * sine);
}

double cone_slope(enum cone_fit fit, double angle)
{
    return cone_numerator(fit, angle) * sin(angle);
}

double cone_strength(enum cone_fit fit, double angle, double cohesion)
{
    return 3.0 * cone_numerator(fit, angle) * cohesion * cos(angle);
}

double cone_slope_limit(enum cone_fit fit)
{
    return cone_numerator(fit, asin(1.0));
}

double cone_angle(enum cone_fit fit, double slope)
{
    double scaled = slope / (2.0 * sqrt(2.0 / 3.0));
    switch (fit) {
    case CONE_FIT_OUTER:
        return asin(3.0 * scaled / (1.0 + scaled));
    case CONE_FIT_INNER:
        return asin(3.0 * scaled / (1.0 - scaled));
    case CONE_FIT_PLANE_STRAIN:
        return asin(3.0 * slope / sqrt(2.0));
    case CONE_FIT_PLANE_STRAIN_ASSOCIATED:
        break;
    }
    return asin(3.0 * slope / sqrt(2.0 - 3.0 * slope * slope));
}

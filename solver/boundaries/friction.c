/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/boundary.h"

static double coulomb(double friction_coefficient, double normal_impulse)
{
    return friction_coefficient * normal_impulse;
}

static const struct parameter parameters[] = {
    {.key = "friction_coefficient",
     .symbol = "mu",
     .unit = "1",
     .kind = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .alternative = "friction",
     .meaning = "ratio of the largest tangential to the normal force"},
    {.key = "friction_angle",
     .symbol = "arctan mu",
     .unit = "deg",
     .kind = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 90,
     .below_maximum = true,
     .required = true,
     .default_value = NAN,
     .alternative = "friction",
     .meaning = "angle whose tangent is the friction coefficient"},
    {.key = NULL},
};

const struct boundary_condition boundary_friction = {
    .name = "friction",
    .reference = "Mast 2013, sec. B.2.5; Andersen and Andersen 2012, eq. 53-55, with the friction "
                 "opposing the free velocity",
    .summary = "Coulomb friction: sticks up to the limit, slides against it beyond",
    .parameters = parameters,
    .tangential_limit = coulomb,
};

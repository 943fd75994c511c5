/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/boundary.h"

/* Coulomb with adhesion: the area in contact carries `adhesion` beside the share of the push. */
static double coulomb(const struct wall_face *face, const struct wall_grip *grip)
{
    return face->friction_coefficient * grip->push + face->adhesion * grip->area * grip->time_step;
}

/* Voellmy's friction slope mu + v^2 / (xi h) of a flow of depth h, times its weight rho g h per
 * area, is the stress mu sigma_n + rho g v^2 / xi: its second part knows nothing of the depth, and
 * acts on the area of a node as it does below a column. v is the sliding speed, which in the
 * depth-averaged model of a plug is that of the whole column. */
static double voellmy(const struct wall_face *face, const struct wall_grip *grip)
{
    if (face->turbulence <= 0)
        return 0.0;
    return grip->density * grip->gravity * grip->area * grip->time_step / face->turbulence;
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
    {.key = "adhesion",
     .symbol = "a",
     .unit = "Pa",
     .kind = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = INFINITY,
     .meaning = "shear stress that the boundary holds without being pushed"},
    {.key = "turbulence",
     .symbol = "xi",
     .unit = "m/s^2",
     .kind = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = INFINITY,
     .above_minimum = true,
     .default_value = NAN,
     .meaning = "Voellmy: the shear stress rho g v^2 / xi acts beside friction"},
    {.key = NULL},
};

const struct boundary_condition boundary_friction = {
    .name = "friction",
    .reference = "Mast 2013, sec. B.2.5; Andersen and Andersen 2012, eq. 53-55, with the friction "
                 "opposing the free velocity; turbulence: Voellmy 1955",
    .summary = "Coulomb friction: sticks up to the limit, slides against it beyond",
    .parameters = parameters,
    .tangential_limit = coulomb,
    .tangential_drag = voellmy,
};

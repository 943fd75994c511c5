/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/boundary.h"

static double unlimited(double friction_coefficient, double normal_impulse)
{
    (void)friction_coefficient;
    (void)normal_impulse;
    return INFINITY;
}

static const struct parameter parameters[] = {{.key = NULL}};

const struct boundary_condition boundary_stick = {
    .name = "stick",
    .reference = "Mast 2013, sec. B.2.5 (Fixed)",
    .summary = "the material does not move at the boundary",
    .parameters = parameters,
    .tangential_limit = unlimited,
};

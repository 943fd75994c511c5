/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/boundary.h"

static double unlimited(const struct wall_face *face, const struct wall_grip *grip)
{
    (void)face;
    (void)grip;
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

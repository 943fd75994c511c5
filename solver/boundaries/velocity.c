/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/boundary.h"

/* The velocity belongs to the boundary, which moves along with it. */
static const struct parameter parameters[] = {{.key = NULL}};

const struct boundary_condition boundary_velocity = {
    .name = "velocity",
    .reference = "Mast 2013, sec. B.2.5 (Fixed), in the frame of the boundary",
    .summary = "the material moves with a prescribed velocity, on all axes or on some",
    .parameters = parameters,
    .prescribes = true,
};

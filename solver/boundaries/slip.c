/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/boundary.h"

static const struct parameter parameters[] = {{.key = NULL}};

const struct boundary_condition boundary_slip = {
    .name = "slip",
    .reference = "Mast 2013, sec. B.2.5 (Planar)",
    .summary = "no motion along the normal, free along the boundary",
    .parameters = parameters,
};

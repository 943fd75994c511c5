/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/boundary.h"

static const struct parameter parameters[] = {{.key = NULL}};

const struct boundary_condition boundary_eliminate = {
    .name = "eliminate",
    .reference = "Mast 2013, sec. B.2.5 (Eliminate)",
    .summary = "takes out the particles that pass behind the boundary; their mass is booked",
    .parameters = parameters,
    .eliminates = true,
};

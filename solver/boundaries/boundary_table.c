/* SPDX-License-Identifier: Apache-2.0 */
#include "boundaries/boundary.h"

#include <string.h>

#define BOUNDARY(symbol) extern const struct boundary_condition boundary_##symbol;
#include "boundaries/boundaries.def"
#undef BOUNDARY

const struct boundary_condition *const boundary_table[] = {
#define BOUNDARY(symbol) &boundary_##symbol,
#include "boundaries/boundaries.def"
#undef BOUNDARY
};
const size_t boundary_count = sizeof boundary_table / sizeof boundary_table[0];

const struct boundary_condition *boundary_find(const char *name)
{
    for (size_t index = 0; index < boundary_count; index++) {
        if (strcmp(boundary_table[index]->name, name) == 0)
            return boundary_table[index];
    }
    return NULL;
}

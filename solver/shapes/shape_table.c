/* SPDX-License-Identifier: Apache-2.0 */
#include "shapes/shape.h"

#include <string.h>

#define SHAPE(symbol) extern const struct shape shape_##symbol;
#include "shapes/shapes.def"
#undef SHAPE

const struct shape *const shape_table[] = {
#define SHAPE(symbol) &shape_##symbol,
#include "shapes/shapes.def"
#undef SHAPE
};
const size_t shape_count = sizeof shape_table / sizeof shape_table[0];

const struct shape *shape_find(const char *name)
{
    for (size_t index = 0; index < shape_count; index++) {
        if (strcmp(shape_table[index]->name, name) == 0)
            return shape_table[index];
    }
    return NULL;
}

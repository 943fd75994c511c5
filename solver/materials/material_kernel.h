/* SPDX-License-Identifier: Apache-2.0 */
/* What the models' loops share: components of a batch in and out of value structs. The number of
 * components is an argument that the compiler knows, so that the physics is written once and
 * compiled for 3, 4 and 6 of them. */
#ifndef TALUS_MATERIAL_KERNEL_H
#define TALUS_MATERIAL_KERNEL_H

#include "materials/material.h"
#include "math/tensor.h"

/* Slots that a model works on between two of its stages: small enough to stay in the first-level
 * cache. */
enum { MATERIAL_CHUNK = 64 };

/* Calls an always-inline kernel(constants, batch, components) with components as a constant. */
#define MATERIAL_INSTANTIATE(kernel, constants, batch)                                             \
    do {                                                                                           \
        if ((batch)->component_count == 3)                                                         \
            kernel(constants, batch, 3);                                                           \
        else if ((batch)->component_count == 4)                                                    \
            kernel(constants, batch, 4);                                                           \
        else                                                                                       \
            kernel(constants, batch, 6);                                                           \
    } while (0)

TALUS_INLINE struct sym3 components_load(double *const array[SYM3_COMPONENTS], size_t slot,
                                         size_t components)
{
    struct sym3 a = {.xx = array[0][slot], .yy = array[1][slot], .zz = array[2][slot]};
    if (components > 3)
        a.xy = array[3][slot];
    if (components > 4) {
        a.yz = array[4][slot];
        a.xz = array[5][slot];
    }
    return a;
}

TALUS_INLINE void components_store(double *const array[SYM3_COMPONENTS], size_t slot,
                                   size_t components, struct sym3 a)
{
    array[0][slot] = a.xx;
    array[1][slot] = a.yy;
    array[2][slot] = a.zz;
    if (components > 3)
        array[3][slot] = a.xy;
    if (components > 4) {
        array[4][slot] = a.yz;
        array[5][slot] = a.xz;
    }
}

TALUS_INLINE struct sym3 components_load_rate(const struct material_batch *batch, size_t slot,
                                              size_t components)
{
    const double *const *rate = batch->rate;
    struct sym3 a = {.xx = rate[0][slot], .yy = rate[1][slot], .zz = rate[2][slot]};
    if (components > 3)
        a.xy = rate[3][slot];
    if (components > 4) {
        a.yz = rate[4][slot];
        a.xz = rate[5][slot];
    }
    return a;
}

TALUS_INLINE double minimum(double a, double b)
{
    return a < b ? a : b;
}

TALUS_INLINE double maximum(double a, double b)
{
    return a > b ? a : b;
}

#endif

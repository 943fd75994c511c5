/* SPDX-License-Identifier: Apache-2.0 */
/* What the models' loops share: components of a batch in and out of value structs. The number of
 * components is an argument that the compiler knows, so that the physics is written once and
 * compiled for 3, 4 and 6 of them. */
#ifndef TALUS_MATERIAL_KERNEL_H
#define TALUS_MATERIAL_KERNEL_H

#include "materials/material.h"
#include "math/tensor.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

/* Slots that a model works on between two of its stages: small enough to stay in the first-level
 * cache. */
enum { MATERIAL_CHUNK = 64 };
/* For the arrays in between: without it the vectoriser adds a loop that seeks alignment. */
#define MATERIAL_ALIGNED _Alignas(64)

/* Calls an always-inline kernel(constants, batch, components) with components as a constant. */
#define MATERIAL_INSTANTIATE(kernel, constants, batch)                                             \
    ((batch)->component_count == 3   ? kernel(constants, batch, 3)                                 \
     : (batch)->component_count == 4 ? kernel(constants, batch, 4)                                 \
                                     : kernel(constants, batch, 6))

/* A number of slots, in a form that tells the compiler that vectors leave no rest. */
TALUS_INLINE size_t whole_rows(size_t count)
{
    return count & ~(size_t)(MATERIAL_SLOT_MULTIPLE - 1);
}

TALUS_INLINE size_t slot_count(const struct material_batch *batch)
{
    assert(batch->count % MATERIAL_SLOT_MULTIPLE == 0);
    return whole_rows(batch->count);
}

/* Slots of the chunk that starts at `begin`. */
TALUS_INLINE size_t chunk_count(size_t slots, size_t begin)
{
    size_t left = slots - begin;
    return whole_rows(left < MATERIAL_CHUNK ? left : MATERIAL_CHUNK);
}

/* The sign and the other bits of `count` numbers, or-ed: what a loop left behind can be asked of
 * all slots at once, and vectorises where a reduction over comparisons does not. */
struct number_bits {
    bool negative, nonzero;
};

TALUS_INLINE struct number_bits number_bits(size_t count, const real *values)
{
    const size_t word_count = count * sizeof *values / sizeof(uint64_t);
    const uint64_t sign = sizeof *values == sizeof(uint64_t) ? UINT64_C(0x8000000000000000)
                                                             : UINT64_C(0x8000000080000000);
    uint64_t bits = 0;
    for (size_t index = 0; index < word_count; index++) {
        uint64_t word;
        memcpy(&word, (const char *)values + index * sizeof word, sizeof word);
        bits |= word;
    }
    return (struct number_bits){.negative = (bits & sign) != 0, .nonzero = (bits & ~sign) != 0};
}

/* Whether a slot of begin ... begin + count - 1 flowed: out of its plastic strain, which is written
 * by then. */
TALUS_INLINE bool any_flowed(const struct material_batch *batch, size_t begin, size_t count)
{
    return number_bits(count, batch->plastic_strain + begin).nonzero;
}

TALUS_INLINE struct sym3 components_load(real *const array[SYM3_COMPONENTS], size_t slot,
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

TALUS_INLINE void components_store(real *const array[SYM3_COMPONENTS], size_t slot,
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
    const real *const *rate = batch->rate;
    struct sym3 a = {.xx = rate[0][slot], .yy = rate[1][slot], .zz = rate[2][slot]};
    if (components > 3)
        a.xy = rate[3][slot];
    if (components > 4) {
        a.yz = rate[4][slot];
        a.xz = rate[5][slot];
    }
    return a;
}

TALUS_INLINE real minimum(real a, real b)
{
    return a < b ? a : b;
}

TALUS_INLINE real maximum(real a, real b)
{
    return a > b ? a : b;
}

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* The SIMD lanes of a block: lane l holds the particles of cell l of the block, so that node values
 * are loaded and scattered as contiguous vectors, without gathers, conflicts or horizontal sums. */
#ifndef TALUS_LANES_H
#define TALUS_LANES_H

#include "math/real.h"

#include <stdint.h>

/* 32 bytes: four lanes of double equal eight at their peak on AVX-512 machines and waste fewer
 * empty slots in a developed flow, where cells hold unequal numbers of particles. */
#ifdef TALUS_SINGLE
enum { LANE_COUNT = 8 };
typedef int32_t lane_mask __attribute__((vector_size(32))); /* all bits set: true */
#define LANE_MAGNITUDE INT32_MAX
#define LANES_DOWN 1, 2, 3, 4, 5, 6, 7, 8
#define LANES_UP 8, 0, 1, 2, 3, 4, 5, 6
#define LANES_EACH(value) value, value, value, value, value, value, value, value
#else
enum { LANE_COUNT = 4 };
typedef int64_t lane_mask __attribute__((vector_size(32))); /* all bits set: true */
#define LANE_MAGNITUDE INT64_MAX
#define LANES_DOWN 1, 2, 3, 4
#define LANES_UP 4, 0, 1, 2
#define LANES_EACH(value) value, value, value, value
#endif
typedef real lanes __attribute__((vector_size(32)));

static inline lanes lanes_load(const real *values)
{
    return *(const lanes *)__builtin_assume_aligned(values, sizeof(lanes));
}

static inline void lanes_store(real *values, lanes value)
{
    *(lanes *)__builtin_assume_aligned(values, sizeof(lanes)) = value;
}

static inline lanes lanes_splat(real value)
{
    return (lanes){LANES_EACH(value)};
}

/* mask ? yes : 0 */
static inline lanes lanes_keep(lane_mask mask, lanes yes)
{
    return (lanes)(mask & (lane_mask)yes);
}

static inline lanes lanes_select(lane_mask mask, lanes yes, lanes no)
{
    return (lanes)((mask & (lane_mask)yes) | (~mask & (lane_mask)no));
}

static inline lanes lanes_absolute(lanes value)
{
    return (lanes)((lane_mask)value & LANE_MAGNITUDE);
}

/* The larger one; where one is not a number, b. */
static inline lanes lanes_maximum(lanes a, lanes b)
{
#if defined(__AVX__) && defined(TALUS_SINGLE)
    return __builtin_ia32_maxps256(a, b);
#elif defined(__AVX__)
    return __builtin_ia32_maxpd256(a, b);
#else
    return lanes_select(a > b, a, b);
#endif
}

static inline lanes lanes_minimum(lanes a, lanes b)
{
    return -lanes_maximum(-a, -b);
}

/* The largest of the lanes; not a number if one of them is. */
static inline real lanes_largest(lanes value)
{
    real largest = value[0];
    for (int lane = 1; lane < LANE_COUNT; lane++)
        /* NOLINTNEXTLINE(misc-redundant-expression): a != a finds what is not a number. */
        largest = largest >= value[lane] || largest != largest ? largest : value[lane];
    return largest;
}

/* True if a lane is set. */
static inline int lanes_any(lane_mask mask)
{
    int any = 0;
    for (int lane = 0; lane < LANE_COUNT; lane++)
        any |= mask[lane] != 0;
    return any;
}

/* (a0 a1 a2 a3), b -> (a1 a2 a3 b0): the values at the upper x faces of the cells. */
static inline lanes lanes_shift_down(lanes a, real b)
{
    const lanes tail = {b};
    return __builtin_shufflevector(a, tail, LANES_DOWN);
}

/* (a0 a1 a2 a3) -> (0 a0 a1 a2): what the cells give to the nodes at their upper x faces. */
static inline lanes lanes_shift_up(lanes a)
{
    const lanes zero = {0};
    return __builtin_shufflevector(a, zero, LANES_UP);
}

#endif

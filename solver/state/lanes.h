/* SPDX-License-Identifier: Apache-2.0 */
/* The SIMD lanes of a block: lane l holds the particles of cell l of the block, so that node values
 * are loaded and scattered as contiguous vectors, without gathers, conflicts or horizontal sums. */
#ifndef TALUS_LANES_H
#define TALUS_LANES_H

#include <stdint.h>

/* Four lanes equal eight at their peak on AVX-512 machines and waste fewer empty slots in a
 * developed flow, where cells hold unequal numbers of particles. */
enum { LANE_COUNT = 4 };

typedef double lanes __attribute__((vector_size(8 * LANE_COUNT)));
typedef int64_t lane_mask __attribute__((vector_size(8 * LANE_COUNT))); /* all bits set: true */

static inline lanes lanes_load(const double *values)
{
    return *(const lanes *)__builtin_assume_aligned(values, 8 * LANE_COUNT);
}

static inline void lanes_store(double *values, lanes value)
{
    *(lanes *)__builtin_assume_aligned(values, 8 * LANE_COUNT) = value;
}

static inline lanes lanes_splat(double value)
{
    return (lanes){value, value, value, value};
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
    return (lanes)((lane_mask)value & INT64_MAX);
}

/* The larger one; a lane that is not a number stays so, whichever side it comes from. */
static inline lanes lanes_sticky_maximum(lanes a, lanes b)
{
    /* NOLINTNEXTLINE(misc-redundant-expression): a != a finds what is not a number. */
    return lanes_select((a >= b) | (a != a), a, b);
}

/* (a0 a1 a2 a3), b -> (a1 a2 a3 b0): the values at the upper x faces of the cells. */
static inline lanes lanes_shift_down(lanes a, double b)
{
    const lanes tail = {b, 0, 0, 0};
    return __builtin_shufflevector(a, tail, 1, 2, 3, 4);
}

/* (a0 a1 a2 a3) -> (0 a0 a1 a2): what the cells give to the nodes at their upper x faces. */
static inline lanes lanes_shift_up(lanes a)
{
    const lanes zero = {0, 0, 0, 0};
    return __builtin_shufflevector(a, zero, 4, 0, 1, 2);
}

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Sums over many particles, in double whatever the particles are stored in: one lane per cell, the
 * rows of a block one after the other. */
#ifndef TALUS_WIDE_LANES_H
#define TALUS_WIDE_LANES_H

#include "state/lanes.h"

#include <stddef.h>

typedef double wide_lanes __attribute__((vector_size(LANE_COUNT * sizeof(double))));
typedef int64_t wide_mask __attribute__((vector_size(LANE_COUNT * sizeof(double))));

static inline wide_lanes lanes_widen(lanes value)
{
#ifdef TALUS_SINGLE
    wide_lanes wide; /* gcc 12 fails to convert eight lanes at once */
    for (int lane = 0; lane < LANE_COUNT; lane++)
        wide[lane] = (double)value[lane];
    return wide;
#else
    return __builtin_convertvector(value, wide_lanes);
#endif
}

/* The larger one; where one is not a number, b. */
static inline wide_lanes wide_lanes_maximum(wide_lanes a, wide_lanes b)
{
#if defined(__AVX__) && !defined(TALUS_SINGLE)
    return __builtin_ia32_maxpd256(a, b);
#else
    const wide_mask first = a > b;
    return (wide_lanes)((first & (wide_mask)a) | (~first & (wide_mask)b));
#endif
}

/* True if a lane is set. */
static inline int wide_lanes_any(wide_mask mask)
{
#if defined(__AVX__) && !defined(TALUS_SINGLE)
    return __builtin_ia32_movmskpd256((wide_lanes)mask) != 0;
#else
    int64_t any = 0;
    for (int lane = 0; lane < LANE_COUNT; lane++)
        any |= mask[lane];
    return any != 0;
#endif
}

/* mask ? yes : 0 */
static inline wide_lanes wide_lanes_keep(wide_mask mask, wide_lanes yes)
{
    return (wide_lanes)(mask & (wide_mask)yes);
}

static inline double wide_lanes_largest(wide_lanes value)
{
    double largest = value[0];
    for (int lane = 1; lane < LANE_COUNT; lane++)
        largest = value[lane] > largest ? value[lane] : largest;
    return largest;
}

static inline double wide_lanes_sum(wide_lanes value)
{
    double sum = value[0];
    for (int lane = 1; lane < LANE_COUNT; lane++)
        sum += value[lane];
    return sum;
}

/* Sum over the slots of weight x value; by lanes, so that it does not depend on the width of the
 * processor's vectors. */
static inline double lanes_weighted_sum(const real *weight, const real *value, size_t count)
{
    wide_lanes sum = {0};
    for (size_t slot = 0; slot < count; slot += LANE_COUNT)
        sum += lanes_widen(lanes_load(weight + slot)) * lanes_widen(lanes_load(value + slot));
    return wide_lanes_sum(sum);
}

#endif

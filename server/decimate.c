/* SPDX-License-Identifier: Apache-2.0 */
#include "decimate.h"

#include <math.h>

/* The points of the smallest and of the largest value in [begin, end). */
static void extremes(const double *value, size_t begin, size_t end, size_t *lowest, size_t *highest)
{
    *lowest = *highest = begin;
    for (size_t index = begin + 1; index < end; index++) {
        if (value[index] < value[*lowest] || isnan(value[*lowest]))
            *lowest = index;
        if (value[index] > value[*highest] || isnan(value[*highest]))
            *highest = index;
    }
}

size_t decimate(double *time, double *value, size_t count, size_t max_points)
{
    if (count <= max_points || max_points < 4)
        return count;
    size_t bucket_count = (max_points - 2) / 2;
    size_t inner = count - 2, kept = 1;
    for (size_t bucket = 0; bucket < bucket_count; bucket++) {
        size_t begin = 1 + inner * bucket / bucket_count;
        size_t end = 1 + inner * (bucket + 1) / bucket_count;
        size_t lowest, highest;
        extremes(value, begin, end, &lowest, &highest);
        size_t first = lowest < highest ? lowest : highest;
        size_t second = lowest < highest ? highest : lowest;
        time[kept] = time[first];
        value[kept++] = value[first];
        if (second == first)
            continue;
        time[kept] = time[second];
        value[kept++] = value[second];
    }
    time[kept] = time[count - 1];
    value[kept++] = value[count - 1];
    return kept;
}

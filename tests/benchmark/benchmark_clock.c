/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_clock.h"

#include "explicit/stage_clock.h"

#include <math.h>
#include <stdlib.h>

double benchmark_clock_seconds(clockid_t clock)
{
    struct timespec now = {0};
    (void)clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double benchmark_thread_seconds(void)
{
    return benchmark_clock_seconds(CLOCK_THREAD_CPUTIME_ID);
}

double benchmark_wall_seconds(void)
{
    return benchmark_clock_seconds(CLOCK_MONOTONIC);
}

/* Both clocks at one time: the reading that took least, so that nobody came between. */
static void read_together(double *seconds, uint64_t *ticks)
{
    enum { TRIES = 50 };
    uint64_t least = UINT64_MAX;
    for (int try = 0; try < TRIES; try++) {
        const uint64_t before = stage_clock_read();
        const double now = benchmark_wall_seconds();
        const uint64_t after = stage_clock_read();
        if (after - before >= least)
            continue;
        least = after - before;
        *ticks = before + least / 2;
        *seconds = now;
    }
}

/* [ns] the least that a reading of the stage clock costs. */
static double least_lap(void)
{
    enum { LAPS = 5000, TRIES = 20 };
    struct stage_clock clock = {0};
    double least = INFINITY;
    for (int try = 0; try < TRIES; try++) {
        const double start = benchmark_thread_seconds();
        stage_clock_start(&clock);
        for (int lap = 0; lap < LAPS; lap++)
            stage_clock_lap(&clock, STAGE_WAIT);
        least = fmin(least, 1e9 * (benchmark_thread_seconds() - start) / LAPS);
    }
    return least;
}

void benchmark_calibrate(double *nanoseconds_per_tick, double *nanoseconds_per_lap)
{
    double begin = 0, end = 0;
    uint64_t first = 0, last = 0;
    read_together(&begin, &first);
    while (benchmark_wall_seconds() - begin < 0.02) {
    }
    read_together(&end, &last);
    *nanoseconds_per_tick = 1e9 * (end - begin) / (double)(last - first);
    *nanoseconds_per_lap = least_lap();
}

static int compare(const void *a, const void *b)
{
    const double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

void benchmark_sort(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare);
}

double benchmark_quantile(const double *sorted, size_t count, double share)
{
    const double place = share * (double)(count - 1);
    const size_t low = (size_t)floor(place);
    const size_t high = low + 1 < count ? low + 1 : low;
    return sorted[low] + (place - (double)low) * (sorted[high] - sorted[low]);
}

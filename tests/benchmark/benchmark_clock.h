/* SPDX-License-Identifier: Apache-2.0 */
/* Clocks and order statistics of the benchmark. */
#ifndef BENCHMARK_CLOCK_H
#define BENCHMARK_CLOCK_H

#include <stddef.h>
#include <time.h>

/* Seconds of a clock. */
double benchmark_clock_seconds(clockid_t clock);
/* Seconds of processor time of the calling thread: other programs on the machine do not count. */
double benchmark_thread_seconds(void);
/* Seconds of a clock on the wall. */
double benchmark_wall_seconds(void);
/* Nanoseconds of a tick of the stage clock, and what a lap costs [ns]. */
void benchmark_calibrate(double *nanoseconds_per_tick, double *nanoseconds_per_lap);

/* Sorts values[count] (count > 0). */
void benchmark_sort(double *values, size_t count);
/* Quantile of sorted values, interpolated. */
double benchmark_quantile(const double *sorted, size_t count, double share);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Measurements: repeats of some steps, timed with and without the stage clock by turns. */
#ifndef BENCHMARK_MEASURE_H
#define BENCHMARK_MEASURE_H

#include "benchmark_case.h"
#include "benchmark_ceiling.h"
#include "explicit/stage_clock.h"

#include <stdint.h>

struct benchmark_effort {
    size_t steps;   /* of a repeat; a multiple of 16 holds the same number of energy checks each */
    size_t repeats; /* of either kind */
};

struct benchmark_result {
    size_t particles, active_cells;
    /* [ns] per particle-step, times threads, without the stage clock. Processor time of the
     * busiest thread (other programs do not count), and time on the wall. */
    double nanoseconds, fastest, quartile_low, quartile_high; /* processor: median, ... */
    double wall_nanoseconds, wall_fastest;
    /* [ns] per particle-step, summed over threads; medians, without the cost of the clock */
    double stage_nanoseconds[STAGE_COUNT];
    double clock_share; /* what the stage clock adds to the time of a step */
    double relative;    /* rate per core over that of the first of the set, repeat by repeat */
    double time_step;   /* [s] mean */
    double simulated;   /* simulated seconds per second of processor time */
    double peak;      /* [GFLOP/s] of a core in the same repeats, in the precision of the program */
    double bandwidth; /* [GB/s] of a core in the same repeats, in place */
    double bytes_stored; /* per particle: its values and ids */
    double bytes_grid;   /* per particle: all that the grid holds, capacities and nodes included */
    double bytes_all;    /* per particle: all that has been allocated, touched or not */
    double bytes_moved;  /* per particle-step: particle values read and written */
    double lane_fill;    /* particles over slots walked */
    double crossings;    /* particles that left their cell, per particle-step */
    double mass_error;   /* relative change over the whole measurement */
    double dissipation;  /* energy dissipated over energy turned over, compact: in a repeat */
    bool failed;         /* the simulation went bad: rates are NAN, all else is nothing */
};

/* Measures a set of setups, repeat by repeat in turns, so that they share what the machine does
 * meanwhile. results[count]. False if nothing could be measured (the reason is on stderr). */
bool benchmark_measure(const struct ceiling *ceiling, const struct benchmark_setup *setups,
                       size_t count, const struct benchmark_effort *effort,
                       struct benchmark_result *results);

#endif

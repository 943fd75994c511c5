/* SPDX-License-Identifier: Apache-2.0 */
/* One measurement: repeats of some steps, timed with and without the stage clock by turns. */
#ifndef BENCHMARK_MEASURE_H
#define BENCHMARK_MEASURE_H

#include "benchmark_case.h"
#include "explicit/stage_clock.h"

#include <stdint.h>

struct benchmark_effort {
    size_t steps;   /* of a repeat; a multiple of 16 holds the same number of energy checks each */
    size_t repeats; /* of either kind */
};

struct benchmark_result {
    size_t particles, active_cells;
    double time_step; /* [s] mean */
    /* [ns] processor time per particle-step and thread (threads 1: of that thread; more: wall
     * clock times threads), without the stage clock */
    double nanoseconds, fastest, quartile_low, quartile_high;
    double simulated; /* simulated seconds per second */
    /* [ns] per particle-step, summed over threads; medians, without the cost of the clock */
    double stage_nanoseconds[STAGE_COUNT];
    double clock_share;  /* what the stage clock adds to the time of a step */
    double bytes_stored; /* per particle: its values and ids */
    double bytes_grid;   /* per particle: all that the grid holds, capacities and nodes included */
    double lane_fill;    /* particles over slots walked */
    double crossings;    /* particles that left their cell, per particle-step */
    double mass_error;   /* relative change over the whole measurement */
    double plastic_work; /* dissipated in the last repeat over what was put in as motion [-] */
};

/* Runs and measures; false (with the reason on stderr) if something failed. */
bool benchmark_measure(const struct benchmark_setup *setup, const struct benchmark_effort *effort,
                       struct benchmark_result *result);

#endif

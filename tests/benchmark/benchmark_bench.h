/* SPDX-License-Identifier: Apache-2.0 */
/* A simulation on the bench: its setup, its clocks, and what the repeats have shown. */
#ifndef BENCHMARK_BENCH_H
#define BENCHMARK_BENCH_H

#include "benchmark_measure.h"
#include "benchmark_scene.h"
#include "simulation/simulation_private.h"

#include <time.h>

struct bench {
    const struct benchmark_setup *setup;
    const struct benchmark_effort *effort;
    struct benchmark_scene made;
    struct talus_simulation *simulation; /* owned */
    struct stage_clock *clocks;          /* [threads] owned */
    clockid_t *processor_clocks;         /* [threads] owned */
    double *used_before;                 /* [threads] owned */
    double *plain, *wall, *clocked;      /* [repeats] ns per particle-step; owned */
    double *peak, *bandwidth;            /* [repeats] of a core; owned */
    double *stages;                      /* [STAGE_COUNT][repeats] owned */
    double nanoseconds_per_tick, nanoseconds_per_lap;
    double initial_mass;
    double bytes;                             /* allocated when the measurement started */
    double crossers, slots, simulated, steps; /* sums over repeats */
    size_t particles, impulse_count;
    bool failed;
};

/* Seeds it, and runs it up to where it is measured. False: nothing can be measured; the reason is
 * on stderr. */
bool bench_create(struct bench *bench, const struct benchmark_setup *setup,
                  const struct benchmark_effort *effort);
/* Gives the body its motion back, in the other direction than before. What falls keeps falling. */
void bench_impel(struct bench *bench);
/* These set `failed` when the simulation goes bad, and do nothing from then on. */
void bench_take_steps(struct bench *bench, size_t count);
/* The steps of a repeat: untimed, timed, and timed stage by stage. */
void bench_warm(struct bench *bench);
void bench_time_plain(struct bench *bench, size_t repeat);
void bench_time_stages(struct bench *bench, size_t repeat);
/* All but `relative`; leaves bench->plain as it is. */
void bench_summarise(const struct bench *bench, struct benchmark_result *result);
void bench_release(struct bench *bench);

#endif

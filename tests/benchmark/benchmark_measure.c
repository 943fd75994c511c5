/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_measure.h"

#include "benchmark_clock.h"
#include "benchmark_motion.h"
#include "simulation/simulation_private.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A measurement while it runs. */
struct bench {
    const struct benchmark_setup *setup;
    const struct benchmark_effort *effort;
    struct talus_simulation *simulation;
    struct stage_clock *clocks; /* [threads] */
    double *plain;              /* [repeats] ns per particle-step without the clock */
    double *clocked;            /* [repeats] */
    double *stages;             /* [STAGE_COUNT][repeats] */
    double nanoseconds_per_tick, nanoseconds_per_lap;
    double crossers, slots, simulated, steps;
    double running; /* share of the last repeat in which this thread had a processor */
    size_t particles, impulse_count;
};

static bool report(const struct talus_error *error)
{
    (void)fprintf(stderr, "talus-benchmark: %s\n", error->text);
    return false;
}

static void set_clock(struct bench *bench, bool on)
{
    struct run *run = &bench->simulation->run;
    memset(bench->clocks, 0, (size_t)run->threads * sizeof *bench->clocks);
    for (int thread = 0; thread < run->threads; thread++)
        run->scratch[thread].clock = on ? &bench->clocks[thread] : NULL;
}

static bool take_steps(struct bench *bench, size_t count)
{
    struct talus_error error = {0};
    for (size_t step = 0; step < count; step++) {
        if (talus_simulation_step(bench->simulation, &error) != TALUS_OK)
            return report(&error);
    }
    return true;
}

/* Gives the body its motion back, in the other direction than before. */
static bool impel(struct bench *bench)
{
    struct talus_error error = {0};
    const double sign = bench->impulse_count++ % 2 == 0 ? 1.0 : -1.0;
    if (bench->setup->body == BENCHMARK_COMPACT &&
        benchmark_set_motion(&bench->simulation->run, sign, &error) != TALUS_OK)
        return report(&error);
    return true;
}

static double slot_count(const struct run *run)
{
    size_t rows = 0;
    for (size_t index = 0; index < run->grid.block_count; index++)
        rows += run->grid.blocks[index].row_count;
    return (double)(rows * LANE_COUNT);
}

/* Times one repeat: ns per particle-step and thread. */
static bool time_repeat(struct bench *bench, bool clocked, double *nanoseconds)
{
    const struct run *run = &bench->simulation->run;
    const double threads = bench->setup->threads;
    if (!impel(bench))
        return false;
    set_clock(bench, clocked);
    const double before = run->time;
    const double thread_begin = benchmark_thread_seconds(), begin = benchmark_wall_seconds();
    const bool done = take_steps(bench, bench->effort->steps);
    const double elapsed = benchmark_wall_seconds() - begin;
    const double used = benchmark_thread_seconds() - thread_begin;
    const double work = (double)bench->particles * (double)bench->effort->steps;
    *nanoseconds = 1e9 * (bench->setup->threads == 1 ? used : elapsed) * threads / work;
    bench->running = bench->setup->threads == 1 ? used / elapsed : 1.0;
    if (!clocked) {
        bench->simulated += run->time - before;
        bench->steps += (double)bench->effort->steps;
    }
    return done;
}

static bool stage_is_parallel(size_t stage)
{
    return stage == STAGE_FIRST_PASS || (stage >= STAGE_GATHER && stage <= STAGE_WAIT);
}

/* Adds up the clocks of a repeat. Stages of one thread keep all threads from working. The stage
 * clock runs on while other programs have the processor: its sums shrink to the time used. */
static void read_stages(struct bench *bench, size_t repeat)
{
    const double work = (double)bench->particles * (double)bench->effort->steps;
    const double threads = bench->setup->threads;
    for (size_t stage = 0; stage < STAGE_COUNT; stage++) {
        double sum = 0;
        for (int thread = 0; thread < bench->setup->threads; thread++)
            sum += (double)bench->clocks[thread].ticks[stage] * bench->nanoseconds_per_tick *
                       bench->running -
                   (double)bench->clocks[thread].laps[stage] * bench->nanoseconds_per_lap;
        bench->stages[stage * bench->effort->repeats + repeat] =
            fmax(0.0, sum) * (stage_is_parallel(stage) ? 1.0 : threads) / work;
    }
    bench->crossers += (double)bench->clocks[0].crossers / work;
    bench->slots += slot_count(&bench->simulation->run);
}

static bool run_repeats(struct bench *bench)
{
    double ignored = 0;
    benchmark_calibrate(&bench->nanoseconds_per_tick, &bench->nanoseconds_per_lap);
    if (!time_repeat(bench, true, &ignored)) /* touches all memory, warms the processor */
        return false;
    for (size_t repeat = 0; repeat < bench->effort->repeats; repeat++) {
        if (!time_repeat(bench, false, &bench->plain[repeat]) ||
            !time_repeat(bench, true, &bench->clocked[repeat]))
            return false;
        read_stages(bench, repeat);
    }
    return true;
}

static double stored_bytes(const struct run *run)
{
    const struct particle_layout *layout = &run->grid.layout;
    return (double)(layout->double_count * sizeof(double) + sizeof(uint32_t) +
                    (layout->has_body ? sizeof(uint16_t) : 0));
}

static void summarise(struct bench *bench, struct benchmark_result *result)
{
    const struct run *run = &bench->simulation->run;
    const size_t repeats = bench->effort->repeats;
    struct talus_simulation_state state;
    talus_simulation_get_state(bench->simulation, &state);
    benchmark_sort(bench->plain, repeats);
    benchmark_sort(bench->clocked, repeats);
    result->particles = bench->particles;
    result->active_cells = state.active_cell_count;
    result->fastest = bench->plain[0];
    result->quartile_low = benchmark_quantile(bench->plain, repeats, 0.25);
    result->nanoseconds = benchmark_quantile(bench->plain, repeats, 0.5);
    result->quartile_high = benchmark_quantile(bench->plain, repeats, 0.75);
    result->clock_share =
        benchmark_quantile(bench->clocked, repeats, 0.5) / result->nanoseconds - 1.0;
    result->time_step = bench->simulated / bench->steps;
    result->simulated = result->time_step /
                        (1e-9 * result->nanoseconds * (double)bench->particles) *
                        bench->setup->threads;
    for (size_t stage = 0; stage < STAGE_COUNT; stage++) {
        double *values = bench->stages + stage * repeats;
        benchmark_sort(values, repeats);
        result->stage_nanoseconds[stage] = benchmark_quantile(values, repeats, 0.5);
    }
    result->bytes_stored = stored_bytes(run);
    result->bytes_grid = (double)state.memory_bytes / (double)bench->particles;
    result->lane_fill = (double)bench->particles * (double)repeats / bench->slots;
    result->crossings = bench->crossers / (double)repeats;
    result->plastic_work = run->energy.plastic / fmax(run->audit.initial_stored, 1e-300);
}

static bool prepare(struct bench *bench, struct talus_scene *scene)
{
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = bench->setup->threads};
    struct talus_simulation_state state;
    const size_t repeats = bench->effort->repeats;
    bench->clocks = calloc((size_t)bench->setup->threads, sizeof *bench->clocks);
    bench->plain = calloc(repeats, sizeof *bench->plain);
    bench->clocked = calloc(repeats, sizeof *bench->clocked);
    bench->stages = calloc(STAGE_COUNT * repeats, sizeof *bench->stages);
    if (bench->clocks == NULL || bench->plain == NULL || bench->clocked == NULL ||
        bench->stages == NULL) {
        (void)fprintf(stderr, "talus-benchmark: out of memory\n");
        return false;
    }
    if (!benchmark_scene(bench->setup, scene))
        return false;
    if (talus_simulation_create(scene, &options, &bench->simulation, &error) != TALUS_OK)
        return report(&error);
    talus_simulation_get_state(bench->simulation, &state);
    bench->particles = state.particle_count;
    return true;
}

bool benchmark_measure(const struct benchmark_setup *setup, const struct benchmark_effort *effort,
                       struct benchmark_result *result)
{
    struct bench bench = {.setup = setup, .effort = effort};
    struct talus_scene scene = {0};
    double momentum[3], before = 0, after = 0;
    memset(result, 0, sizeof *result);
    bool good = prepare(&bench, &scene);
    if (good) {
        run_measure_momentum(&bench.simulation->run, momentum, &before);
        good = run_repeats(&bench);
    }
    if (good) {
        run_measure_momentum(&bench.simulation->run, momentum, &after);
        summarise(&bench, result);
        result->mass_error = fabs(after - before) / before;
    }
    talus_simulation_destroy(bench.simulation);
    talus_scene_release(&scene);
    free(bench.clocks);
    free(bench.plain);
    free(bench.clocked);
    free(bench.stages);
    return good;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_bench.h"

#include "benchmark_clock.h"
#include "benchmark_machine.h"
#include "benchmark_motion.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

/* After so many steps a compact body is seeded anew. */
enum { COMPACT_STEPS = 256 };

static void fail(struct bench *bench, const struct talus_error *error)
{
    (void)fprintf(stderr, "talus-benchmark: %s, %s, %s: %s\n", bench->setup->subject->name,
                  benchmark_body_word(bench->setup), benchmark_ordering_word(bench->setup),
                  error->text);
    bench->failed = true;
}

static void set_clock(struct bench *bench, bool on)
{
    struct run *run = &bench->simulation->run;
    memset(bench->clocks, 0, (size_t)run->threads * sizeof *bench->clocks);
    for (int thread = 0; thread < run->threads; thread++)
        run->scratch[thread].clock = on ? &bench->clocks[thread] : NULL;
}

void bench_take_steps(struct bench *bench, size_t count)
{
    struct talus_error error = {0};
    for (size_t step = 0; step < count && !bench->failed; step++) {
        if (talus_simulation_step(bench->simulation, &error) != TALUS_OK)
            fail(bench, &error);
    }
}

static bool seed(struct bench *bench)
{
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = bench->setup->threads,
                                                     .all_threads = true};
    talus_simulation_destroy(bench->simulation);
    bench->simulation = NULL;
    bench->impulse_count = 0;
    if (talus_simulation_create(&bench->made.scene, &options, &bench->simulation, &error) ==
        TALUS_OK)
        return true;
    fail(bench, &error);
    return false;
}

void bench_impel(struct bench *bench)
{
    struct talus_error error = {0};
    const bool falls =
        bench->setup->body == BENCHMARK_FLOW && bench->setup->subject->flow_material != NULL;
    if (falls || bench->failed)
        return;
    /* Plastic strain changes the shape slowly. */
    if (bench->setup->body == BENCHMARK_COMPACT &&
        bench->impulse_count * bench->effort->steps >= COMPACT_STEPS && !seed(bench))
        return;
    const double sign = bench->impulse_count++ % 2 == 0 ? 1.0 : -1.0;
    if (benchmark_set_motion(&bench->simulation->run, sign, &error) != TALUS_OK)
        fail(bench, &error);
}

static double work_of(const struct bench *bench)
{
    return (double)bench->particles * (double)bench->effort->steps;
}

static double used_by(const struct bench *bench, int thread)
{
    return benchmark_clock_seconds(bench->processor_clocks[thread]);
}

/* Takes the steps of a repeat. Seconds on the wall, and of the busiest thread's processor: a thread
 * that waits for one without a processor soon sleeps. */
static void time_steps(struct bench *bench, double *wall, double *used)
{
    for (int thread = 0; thread < bench->setup->threads; thread++)
        bench->used_before[thread] = used_by(bench, thread);
    const double begin = benchmark_wall_seconds();
    bench_take_steps(bench, bench->effort->steps);
    *wall = benchmark_wall_seconds() - begin;
    *used = 0;
    for (int thread = 0; thread < bench->setup->threads; thread++)
        *used = fmax(*used, used_by(bench, thread) - bench->used_before[thread]);
}

void bench_warm(struct bench *bench)
{
    double wall, used;
    bench_impel(bench);
    set_clock(bench, false);
    time_steps(bench, &wall, &used);
}

void bench_time_plain(struct bench *bench, size_t repeat)
{
    const struct run *run = &bench->simulation->run;
    const double scale = 1e9 * bench->setup->threads / work_of(bench);
    double wall, used;
    bench_impel(bench);
    set_clock(bench, false);
    const double before = run->time;
    time_steps(bench, &wall, &used);
    bench->plain[repeat] = scale * used;
    bench->wall[repeat] = scale * wall;
    bench->simulated += run->time - before;
    bench->steps += (double)bench->effort->steps;
}

static bool stage_is_parallel(size_t stage)
{
    return stage == STAGE_FIRST_PASS || stage == STAGE_ENERGY_CHECK ||
           (stage >= STAGE_GATHER && stage <= STAGE_WAIT);
}

static double slot_count(const struct run *run)
{
    size_t rows = 0;
    for (size_t index = 0; index < run->grid.block_count; index++)
        rows += run->grid.blocks[index].row_count;
    return (double)(rows * LANE_COUNT);
}

void bench_time_stages(struct bench *bench, size_t repeat)
{
    const double threads = bench->setup->threads, work = work_of(bench);
    double wall, used;
    bench_impel(bench);
    set_clock(bench, true);
    time_steps(bench, &wall, &used);
    bench->clocked[repeat] = 1e9 * used * threads / work;
    /* The stage clock runs on while other programs have the processor. */
    const double running = fmin(1.0, used / wall);
    for (size_t stage = 0; stage < STAGE_COUNT; stage++) {
        double sum = 0;
        for (int thread = 0; thread < bench->setup->threads; thread++)
            sum +=
                (double)bench->clocks[thread].ticks[stage] * bench->nanoseconds_per_tick * running -
                (double)bench->clocks[thread].laps[stage] * bench->nanoseconds_per_lap;
        /* Where one thread works all others wait. */
        bench->stages[stage * bench->effort->repeats + repeat] =
            fmax(0.0, sum) * (stage_is_parallel(stage) ? 1.0 : threads) / work;
    }
    bench->crossers += (double)bench->clocks[0].crossers / work;
    bench->slots += slot_count(&bench->simulation->run);
}

static bool allocate(struct bench *bench)
{
    const size_t repeats = bench->effort->repeats, threads = (size_t)bench->setup->threads;
    double **arrays[] = {&bench->plain, &bench->wall, &bench->clocked, &bench->peak,
                         &bench->bandwidth};
    bool good = true;
    bench->clocks = calloc(threads, sizeof *bench->clocks);
    bench->processor_clocks = calloc(threads, sizeof *bench->processor_clocks);
    bench->used_before = calloc(threads, sizeof *bench->used_before);
    bench->stages = calloc(STAGE_COUNT * repeats, sizeof *bench->stages);
    for (size_t index = 0; index < sizeof arrays / sizeof arrays[0]; index++) {
        *arrays[index] = calloc(repeats, sizeof(double));
        good = good && *arrays[index] != NULL;
    }
    return good && bench->clocks != NULL && bench->processor_clocks != NULL &&
           bench->used_before != NULL && bench->stages != NULL;
}

/* The threads of a team stay the same from one parallel region to the next. */
static bool find_processor_clocks(struct bench *bench)
{
    int bad = 0;
#pragma omp parallel num_threads(bench->setup->threads) reduction(+ : bad)
    bad += pthread_getcpuclockid(pthread_self(), &bench->processor_clocks[omp_get_thread_num()]);
    return bad == 0;
}

/* To where the measurement starts, always with modified_last at the default step, which is stable
 * and gives both orderings the same body; then with the ordering and the step of the setup. */
static void develop(struct bench *bench)
{
    struct talus_error error = {0};
    const struct benchmark_setup *setup = bench->setup;
    struct run *run = &bench->simulation->run;
    if (bench->made.develop_time == 0)
        return;
    bench_impel(bench);
    while (!bench->failed && run->time < bench->made.develop_time)
        bench_take_steps(bench, 1);
    const double courant = setup->courant > 0 ? setup->courant : run->scene.solver.courant;
    if (!bench->failed && benchmark_set_ordering(run, setup->last, courant, &error) != TALUS_OK)
        fail(bench, &error);
}

static bool complain(const char *text)
{
    (void)fprintf(stderr, "talus-benchmark: %s\n", text);
    return false;
}

bool bench_create(struct bench *bench, const struct benchmark_setup *setup,
                  const struct benchmark_effort *effort)
{
    struct talus_simulation_state state;
    double momentum[3];
    *bench = (struct bench){.setup = setup, .effort = effort};
    if (!allocate(bench))
        return complain("out of memory");
    if (!find_processor_clocks(bench))
        return complain("no clocks of processor time");
    const double bytes = benchmark_allocated_memory();
    if (!benchmark_scene_create(setup, &bench->made) || !seed(bench))
        return false;
    talus_simulation_get_state(bench->simulation, &state);
    run_measure_momentum(&bench->simulation->run, momentum, &bench->initial_mass);
    bench->particles = state.particle_count;
    benchmark_calibrate(&bench->nanoseconds_per_tick, &bench->nanoseconds_per_lap);
    develop(bench);
    bench->bytes = benchmark_allocated_memory() - bytes;
    return true;
}

static double median_of(const double *values, size_t count, double *room)
{
    memcpy(room, values, count * sizeof *values);
    benchmark_sort(room, count);
    return benchmark_quantile(room, count, 0.5);
}

static void summarise_times(const struct bench *bench, double *room,
                            struct benchmark_result *result)
{
    const size_t repeats = bench->effort->repeats;
    result->wall_nanoseconds = median_of(bench->wall, repeats, room);
    result->wall_fastest = room[0];
    result->clock_share = median_of(bench->clocked, repeats, room);
    result->peak = median_of(bench->peak, repeats, room);
    result->bandwidth = median_of(bench->bandwidth, repeats, room);
    for (size_t stage = 0; stage < STAGE_COUNT; stage++)
        result->stage_nanoseconds[stage] =
            median_of(bench->stages + stage * repeats, repeats, room);
    result->nanoseconds = median_of(bench->plain, repeats, room);
    result->fastest = room[0];
    result->quartile_low = benchmark_quantile(room, repeats, 0.25);
    result->quartile_high = benchmark_quantile(room, repeats, 0.75);
    result->clock_share = result->clock_share / result->nanoseconds - 1.0;
}

/* All values once in and once out; `modified_last` reads position, velocity and mass, and writes
 * velocity, once more. */
static void summarise_bytes(const struct bench *bench, struct benchmark_result *result)
{
    const struct particle_layout *layout = &bench->simulation->run.grid.layout;
    const double axes = (double)bench->setup->subject->axis_count;
    result->bytes_stored = (double)(layout->double_count * sizeof(real) + sizeof(uint32_t) +
                                    (layout->has_body ? sizeof(uint16_t) : 0));
    result->bytes_moved = 2.0 * (double)(layout->double_count * sizeof(real));
    if (!bench->setup->last)
        result->bytes_moved += (3.0 * axes + 1.0) * sizeof(real);
}

void bench_summarise(const struct bench *bench, struct benchmark_result *result)
{
    const struct run *run = &bench->simulation->run;
    const double repeats = (double)bench->effort->repeats;
    struct talus_simulation_state state;
    double momentum[3], mass = 0;
    double *room = calloc(bench->effort->repeats, sizeof *room);
    memset(result, 0, sizeof *result);
    result->failed = bench->failed || room == NULL;
    if (result->failed) {
        result->particles = bench->particles;
        result->nanoseconds = result->wall_nanoseconds = result->fastest = NAN;
        result->wall_fastest = result->relative = NAN;
        free(room);
        return;
    }
    talus_simulation_get_state(bench->simulation, &state);
    run_measure_momentum(run, momentum, &mass);
    result->particles = bench->particles;
    result->active_cells = state.active_cell_count;
    summarise_times(bench, room, result);
    summarise_bytes(bench, result);
    result->time_step = bench->simulated / bench->steps;
    result->simulated = result->time_step * bench->setup->threads /
                        (1e-9 * result->nanoseconds * (double)bench->particles);
    result->bytes_grid = (double)state.memory_bytes / (double)bench->particles;
    result->bytes_all = bench->bytes / (double)bench->particles;
    result->lane_fill = (double)bench->particles * repeats / bench->slots;
    result->crossings = bench->crossers / repeats;
    result->mass_error =
        fabs(mass + state.eliminated_mass - bench->initial_mass) / bench->initial_mass;
    result->dissipation = (run->energy.plastic + run->energy.viscous) / run_energy_turnover(run);
    free(room);
}

void bench_release(struct bench *bench)
{
    talus_simulation_destroy(bench->simulation);
    benchmark_scene_release(&bench->made);
    free(bench->clocks);
    free(bench->processor_clocks);
    free(bench->used_before);
    free(bench->plain);
    free(bench->wall);
    free(bench->clocked);
    free(bench->peak);
    free(bench->bandwidth);
    free(bench->stages);
    memset(bench, 0, sizeof *bench);
}

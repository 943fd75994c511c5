/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_witness.h"

#include "benchmark_bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Total strain (6) and accumulated plastic strain of all particles. */
struct look {
    double *strain, *plastic; /* owned */
};

static bool look_create(struct look *look, size_t particles)
{
    look->strain = calloc(6 * particles, sizeof *look->strain);
    look->plastic = calloc(particles, sizeof *look->plastic);
    return look->strain != NULL && look->plastic != NULL;
}

static void look_release(struct look *look)
{
    free(look->strain);
    free(look->plastic);
}

static bool look_at(const struct bench *bench, struct look *look)
{
    struct talus_error error = {0};
    return talus_simulation_read_field(bench->simulation, TALUS_FIELD_STRAIN, look->strain,
                                       &error) == TALUS_OK &&
           talus_simulation_read_field(bench->simulation, TALUS_FIELD_PLASTIC_STRAIN, look->plastic,
                                       &error) == TALUS_OK;
}

static void compare_looks(const struct look *before, const struct look *after, size_t particles,
                          double *square, double *yielding)
{
    for (size_t particle = 0; particle < particles; particle++) {
        for (size_t component = 0; component < 6; component++) {
            const size_t index = 6 * particle + component;
            const double change = after->strain[index] - before->strain[index];
            *square += (component < 3 ? 1.0 : 2.0) * change * change;
        }
        *yielding += after->plastic[particle] > before->plastic[particle];
    }
}

static bool watch(struct bench *bench, struct look looks[2], struct benchmark_witness *witness)
{
    const double work = (double)bench->particles * (double)bench->effort->steps;
    double square = 0, yielding = 0;
    bench_impel(bench);
    bool good = !bench->failed && look_at(bench, &looks[0]);
    for (size_t step = 0; good && step < bench->effort->steps; step++) {
        bench_take_steps(bench, 1);
        good = !bench->failed && look_at(bench, &looks[(step + 1) % 2]);
        if (good)
            compare_looks(&looks[step % 2], &looks[(step + 1) % 2], bench->particles, &square,
                          &yielding);
    }
    witness->strain = sqrt(square / work);
    witness->plastic = yielding / work;
    return good;
}

bool benchmark_witness_call(const struct benchmark_setup *setup, size_t particles, size_t steps,
                            struct benchmark_witness *witness)
{
    struct benchmark_setup small = *setup;
    const struct benchmark_effort effort = {.steps = steps, .repeats = 1};
    struct bench bench;
    struct look looks[2] = {{NULL, NULL}, {NULL, NULL}};
    small.particles = particles < setup->particles ? particles : setup->particles;
    small.threads = 1;
    small.tracked = true;
    bool good = bench_create(&bench, &small, &effort);
    for (size_t index = 0; good && index < 2; index++)
        good = look_create(&looks[index], bench.particles);
    good = good && watch(&bench, looks, witness);
    for (size_t index = 0; index < 2; index++)
        look_release(&looks[index]);
    bench_release(&bench);
    return good;
}

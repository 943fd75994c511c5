/* SPDX-License-Identifier: Apache-2.0 */
/* What a scene costs, before anything is allocated for it. */
#include "seeding/seeding.h"
#include "simulation/simulation_private.h"
#include "simulation/single_precision.h"
#include "simulation/speed_forecast.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static uint64_t saturate(double value)
{
    return value >= 1.8e19 ? UINT64_MAX : (uint64_t)value;
}

static uint64_t materials_of(const struct run *run)
{
    uint64_t materials = 0;
    for (size_t index = 0; index < run->scene.body_count; index++)
        materials |= (uint64_t)1 << run->body_material[index];
    return materials;
}

/* Steps of that length, the shortened last one included, in the run and before t = 0. */
static double steps_of(const struct talus_scene *scene, double step)
{
    return ceil((scene->duration + scene->solver.settle_time) / step * (1 - 1e-12));
}

static void estimate_steps(const struct run *run, struct talus_estimate *estimate)
{
    const struct talus_scene *scene = &run->scene;
    const struct speed_forecast speed = speed_forecast_make(run);
    const uint64_t materials = materials_of(run);
    const double fixed = scene->solver.time_step, courant = scene->solver.courant;
    const double critical = run_critical_time_step(run, speed.start, materials);
    double low = fixed, expected = fixed, high = fixed;
    if (!(fixed > 0)) {
        low = courant * run_critical_time_step(run, speed.low, materials);
        expected = courant * run_critical_time_step(run, speed.expected, materials);
        high = courant * run_critical_time_step(run, speed.high, materials);
    }
    estimate->critical_time_step = critical;
    estimate->time_step = fixed > 0 ? fixed : courant * critical;
    estimate->step_count = saturate(steps_of(scene, expected));
    estimate->step_count_low = saturate(steps_of(scene, low));
    /* Rounding of the clock takes one more, sharing the remainder (run_choose_time_step) another.
     */
    estimate->step_count_high = saturate(steps_of(scene, high) + (fixed > 0 ? 1 : 2));
    estimate->crossing_share =
        fmin(1, speed.motion * expected / domain_smallest_cell(&run->grid.domain));
}

/* Of the build that will run the scene, which may not be this one. */
static size_t number_bytes(const struct talus_scene *scene)
{
    return scene->solver.precision == TALUS_PRECISION_SINGLE ? sizeof(float) : sizeof(double);
}

enum talus_status talus_simulation_estimate(const struct talus_scene *scene,
                                            struct talus_estimate *estimate,
                                            struct talus_error *error)
{
    const struct talus_simulation_options options = {.threads = 1};
    struct run run;
    memset(estimate, 0, sizeof *estimate);
    enum talus_status status = run_build(&run, scene, &options, error);
    if (status != TALUS_OK) {
        run_release(&run);
        return status;
    }
    seeding_count(scene, &estimate->particle_count, &estimate->active_cell_count);
    estimate->useful_threads = threads_that_pay(estimate->particle_count, INT_MAX);
    estimate_steps(&run, estimate);
    const double fixed = scene->solver.time_step, critical = estimate->critical_time_step;
    estimate->bytes_per_particle =
        (uint64_t)layout_particle_bytes(&run.grid.layout, number_bytes(scene));
    estimate->memory_bytes = saturate(
        simulation_memory_estimate(&run, number_bytes(scene), (double)estimate->particle_count,
                                   (double)estimate->active_cell_count));
    if (scene->solver.precision == TALUS_PRECISION_SINGLE) {
        const struct single_precision single = single_precision_estimate(&run, estimate->time_step);
        estimate->motion_error = single.motion_error;
        estimate->force_noise = single.force_noise;
    }
    status = single_precision_check(&run, estimate->time_step, error);
    run_release(&run);
    if (fixed > critical && !scene->solver.allow_unstable)
        return talus_error_set(error, TALUS_INVALID, "over_critical", "/solver/time_step",
                               "%.6g s is above the critical step of %.6g s for this method; use "
                               "\"auto\", a smaller step, or \"allow_unstable\": true",
                               fixed, critical);
    return status;
}

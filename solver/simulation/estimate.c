/* SPDX-License-Identifier: Apache-2.0 */
/* What a scene costs, before anything is allocated for it. */
#include "seeding/seeding.h"
#include "simulation/simulation_private.h"
#include "simulation/single_precision.h"

#include <limits.h>
#include <math.h>
#include <string.h>

static double critical_at_start(const struct run *run)
{
    double signal_speed = 0;
    uint64_t materials = 0;
    for (size_t index = 0; index < run->scene.body_count; index++) {
        const size_t material = run->body_material[index];
        signal_speed =
            fmax(signal_speed, run->materials[material].wave_speed +
                                   seeding_largest_speed(&run->scene, &run->scene.bodies[index]));
        materials |= (uint64_t)1 << material;
    }
    return run_critical_time_step(run, signal_speed, materials);
}

static uint64_t saturate(double value)
{
    return value >= 1.8e19 ? UINT64_MAX : (uint64_t)value;
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
    const double critical = critical_at_start(&run);
    const double fixed = scene->solver.time_step;
    estimate->critical_time_step = critical;
    estimate->time_step = fixed > 0 ? fixed : scene->solver.courant * critical;
    estimate->step_count = saturate(
        ceil((scene->duration + scene->solver.settle_time) / estimate->time_step * (1 - 1e-12)));
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

/* SPDX-License-Identifier: Apache-2.0 */
/* What a run would cost: the solver's own estimate, bytes on disk, and wall seconds by measured
 * rates and what this machine has shown. */
#include "scene/scene_calibration.h"
#include "scene/scene_json.h"

#include "seeding/seeding.h"

#include <math.h>

/* Captured, waiting and being written, at most (worker/background_writer.h). */
static const double frames_in_flight = 4.0;
static const double process_bytes = 22e6; /* of the worker without a simulation */
/* Peaks of memory lie within that of the estimate, down and up (docs/performance.md). */
static const double memory_low = 0.75, memory_high = 1.3;

static json_t *whole(double value)
{
    return json_integer((json_int_t)fmin(value, 9e18));
}

/* [{"name","particles","volume","volume_factor"}], for as many bodies as anyone reads. */
static json_t *describe_bodies(const struct talus_scene *scene)
{
    enum { SHOWN_MAX = 100 };
    json_t *list = json_array();
    for (size_t index = 0; index < scene->body_count && index < SHOWN_MAX; index++) {
        struct seeding_report report;
        seeding_report(scene, index, &report);
        (void)json_array_append_new(
            list, json_pack("{s:s, s:o, s:f, s:f}", "name", scene->bodies[index].name, "particles",
                            whole((double)report.particle_count), "volume", report.volume,
                            "volume_factor", report.volume_factor));
    }
    return list;
}

static double memory_bytes(const struct talus_scene *scene, const struct talus_estimate *estimate,
                           const struct scene_output_size *output)
{
    double frame = sizeof(double) * output->frame_numbers * (double)estimate->particle_count;
    double rows = sizeof(double) * output->row_count * output->column_count;
    double copies = fmin(frames_in_flight, output->frame_count) * frame +
                    (scene->output.checkpoint_every > 0.0 ? output->checkpoint_bytes : 0.0);
    return (double)estimate->memory_bytes + process_bytes + copies + 2.0 * rows;
}

static json_t *interval_json(double low, double expected, double high)
{
    return json_pack("{s:o, s:o, s:o}", "low", whole(low), "expected", whole(expected), "high",
                     whole(high));
}

/* Steps and particle steps of a run. */
struct amount {
    double steps, particle_steps;
};

static struct amount amount_of(const struct talus_estimate *estimate, uint64_t steps)
{
    return (struct amount){(double)steps, (double)steps * (double)estimate->particle_count};
}

/* Standard deviation of the logarithm of the wall time that the number of steps adds. */
static double step_spread(const struct scene_cost *cost, const struct talus_estimate *estimate)
{
    const struct amount low = amount_of(estimate, estimate->step_count_low);
    const struct amount high = amount_of(estimate, estimate->step_count_high);
    const double interval = 4.0; /* standard deviations from low to high */
    return log(scene_cost_wall(cost, high.steps, high.particle_steps) /
               scene_cost_wall(cost, low.steps, low.particle_steps)) /
           interval;
}

/* What whoever keeps the calibration needs to learn from the finished run: its names, processor
 * time as a sum over its metrics, and wall time over that on an idle machine. */
static json_t *learn_json(const struct scene_cost *cost, const struct scene_cost_keys *keys,
                          struct amount amount)
{
    json_t *names = json_array();
    for (size_t level = 0; level < COST_LEVEL_COUNT; level++)
        (void)json_array_append_new(names, json_string(keys->level[level]));
    double wall = scene_cost_wall(cost, amount.steps, amount.particle_steps);
    double cpu = scene_cost_cpu(cost, amount.steps, amount.particle_steps);
    return json_pack(
        "{s:o, s:{s:f, s:f, s:f}, s:s, s:f}", "names", names, "cpu_seconds", "fixed", cost->fixed,
        "steps", cost->step, "particle_steps", cost->particle_step, "wall_name",
        scene_calibration_wait_name(scene_cost_is_files(cost, amount.steps, amount.particle_steps)),
        "wall_over_cpu", wall / cpu);
}

/* Adds wall time, processor time and what can be learned from the run. */
static int add_time(json_t *forecast, const struct talus_scene *scene,
                    const struct talus_estimate *estimate, const struct scene_output_size *output,
                    int threads, const json_t *calibration)
{
    struct scene_cost_keys keys;
    const struct scene_cost cost = scene_cost_make(scene, estimate, output, threads);
    const struct amount amount = amount_of(estimate, estimate->step_count);
    const double wall = scene_cost_wall(&cost, amount.steps, amount.particle_steps);
    const double cpu = scene_cost_cpu(&cost, amount.steps, amount.particle_steps);
    const bool files = scene_cost_is_files(&cost, amount.steps, amount.particle_steps);
    scene_cost_keys_make(scene, (int)cost.threads, &keys);
    const struct calibration_belief belief = scene_calibration_cost(calibration, &keys);
    const struct calibration_interval interval = scene_calibration_interval(
        wall,
        scene_calibration_join(belief, scene_calibration_wait(calibration, files, cost.threads),
                               step_spread(&cost, estimate)));
    return json_object_set_new(forecast, "wall_seconds",
                               json_pack("{s:f, s:f, s:f}", "low", interval.low, "expected",
                                         interval.expected, "high", interval.high)) != 0 ||
           json_object_set_new(forecast, "cpu_seconds", json_real(cpu * exp(belief.mean))) != 0 ||
           json_object_set_new(forecast, "learn", learn_json(&cost, &keys, amount)) != 0;
}

static int add_intervals(json_t *forecast, const struct talus_estimate *estimate,
                         const struct scene_output_size *output, double memory)
{
    return json_object_set_new(
        forecast, "intervals",
        json_pack("{s:o, s:o, s:o}", "steps",
                  interval_json((double)estimate->step_count_low, (double)estimate->step_count,
                                (double)estimate->step_count_high),
                  "memory_bytes", interval_json(memory_low * memory, memory, memory_high * memory),
                  "disk_bytes", interval_json(output->low, output->expected, output->high)));
}

json_t *scene_forecast(const struct talus_scene *scene, int threads, const json_t *calibration,
                       struct talus_error *error)
{
    struct talus_estimate estimate;
    if (talus_simulation_estimate(scene, &estimate, error) != TALUS_OK)
        return NULL;
    const struct scene_output_size output = scene_output_size(scene, &estimate);
    const double memory = memory_bytes(scene, &estimate, &output);
    json_t *forecast =
        json_pack("{s:o, s:o, s:f, s:f, s:o, s:o, s:o, s:o, s:o, s:i}", "particles",
                  whole((double)estimate.particle_count), "active_cells",
                  whole((double)estimate.active_cell_count), "critical_time_step",
                  estimate.critical_time_step, "time_step", estimate.time_step, "steps",
                  whole((double)estimate.step_count), "memory_bytes", whole(memory),
                  "bytes_per_particle", whole((double)estimate.bytes_per_particle), "disk_bytes",
                  whole(output.high + output.checkpoint_bytes), "bodies", describe_bodies(scene),
                  "threads", estimate.useful_threads);
    if (forecast != NULL &&
        add_time(forecast, scene, &estimate, &output, threads, calibration) == 0 &&
        add_intervals(forecast, &estimate, &output, memory) == 0)
        return forecast;
    json_decref(forecast);
    (void)talus_error_memory(error);
    return NULL;
}

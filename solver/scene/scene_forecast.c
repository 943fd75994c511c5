/* SPDX-License-Identifier: Apache-2.0 */
/* What a run would cost: the solver's own estimate, bytes on disk, and wall seconds from measured
 * rates. */
#include "scene/scene_component.h"
#include "scene/scene_cost.h"
#include "scene/scene_json.h"

#include "materials/material.h"
#include "seeding/seeding.h"
#include "talus/simulation.h"

#include <math.h>

/* Particle-steps per second on one core, by number of axes: {fluids and elastic solids, plastic
 * solids}. Processor time measured on a Zen 4 core with the default stress update and cell-based
 * anti-locking: dam break in plane strain 15e6, sand column (Drucker-Prager, Matsuoka-Nakai) 6.9e6,
 * column impact in 3D (capped Drucker-Prager, 73,728 particles) 3.1e6. Other machines and scenes
 * lie within the factor of three of the interval. */
static const double rates[3][2] = {
    {12e6, 8e6},
    {12e6, 6.5e6},
    {5e6, 3e6},
};
/* Of single over double precision: 1.6 to 2.2 over eight cases of talus-benchmark, compact bodies
 * of 8,000 and 500,000 particles; less in flows, whose wider blocks are filled less. */
static const double single_gain = 1.8;
static const double rate_uncertainty = 3.0;
static const double step_overhead = 5e-6;   /* [s] of a step without particles, per thread */
static const double frame_byte_rate = 50e6; /* [bytes/s] written, compressed and synchronised */
static const double start_seconds = 0.1;
/* Captured, waiting and being written, at most (worker/background_writer.h). */
static const double frames_in_flight = 4.0;
static const double process_bytes = 20e6; /* of the worker without a simulation */

static double plastic_share(const struct talus_scene *scene)
{
    double plastic = 0.0;
    for (size_t index = 0; index < scene->body_count; index++) {
        size_t material = scene->bodies[index].material_index;
        if (material_table[scene->materials[material].model_index]->plastic)
            plastic = 1.0;
    }
    return plastic;
}

static double frame_count(const struct talus_scene *scene)
{
    double every = scene->output.frames_every;
    return every > 0.0 ? ceil(scene->duration / every - 1e-9) + 1.0 : 2.0;
}

/* Numbers per particle in a frame, its position included. */
static double frame_components(const struct talus_scene *scene)
{
    double components = 3.0;
    for (size_t field = 0; field < TALUS_FIELD_COUNT; field++) {
        if ((scene->output.frame_fields & (1u << field)) != 0)
            components += (double)scene_field_components(field);
    }
    return components;
}

double scene_frame_bytes(const struct talus_scene *scene, double particles)
{
    const double topology = 8.0 + 8.0 + 1.0; /* connectivity, offset, cell type of a vertex */
    const double header = 20000.0;           /* of a file with its datasets and attributes */
    double number = scene->output.frame_double ? 8.0 : 4.0;
    double once = header + particles * (topology + number * frame_components(scene));
    return frame_count(scene) * once * (scene->output.vtu ? 2.0 : 1.0);
}

/* Columns of a history row: time, energies, probes, reactions of boundaries and their faces. */
static double column_count(const struct talus_scene *scene)
{
    double columns = 1.0 + TALUS_ENERGY_PART_COUNT;
    for (size_t index = 0; index < scene->probe_count; index++)
        columns += scene->probes[index].component < 0 ? (double)scene->axis_count : 1.0;
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        double records = boundary->face_count > 1 ? 1.0 + (double)boundary->face_count : 1.0;
        double moments = scene->axis_count == 3 ? 3.0 : 1.0;
        columns += records * (2.0 * (double)scene->axis_count + moments + 1.0);
    }
    return columns;
}

double scene_history_bytes(const struct talus_scene *scene)
{
    const double copies = 8.0 + 8.0 + 18.0; /* history.bin, results.h5, a number as text */
    double rows = scene->duration / scene->output.history_every + 2.0;
    return rows * column_count(scene) * copies;
}

/* Time of a step over that with cell-based volumetric anti-locking: talus-benchmark, j2 in 3D with
 * 8 particles per cell. Over nodes the passes over particles fall into more parts. */
static double fit_cost(const struct talus_scene *scene)
{
    const double cell_full = 1.1, node_volumetric = 1.8, node_full = 4.0;
    const bool whole = scene->solver.anti_locking_field != TALUS_FIT_VOLUMETRIC;
    switch (scene->solver.anti_locking) {
    case TALUS_CONTROL_NODE:
        return whole ? node_full : node_volumetric;
    case TALUS_CONTROL_HYBRID:
        return node_volumetric * (whole ? cell_full : 1.0);
    default:
        return whole ? cell_full : 1.0;
    }
}

static double wall_seconds(const struct talus_scene *scene, const struct talus_estimate *estimate,
                           int threads, double written)
{
    double share = plastic_share(scene);
    const double *rated = rates[scene->axis_count - 1];
    double rate = rated[0] * (1.0 - share) + rated[1] * share;
    if (scene->solver.precision == TALUS_PRECISION_SINGLE)
        rate *= single_gain;
    rate /= fit_cost(scene);
    double useful = fmax(1.0, fmin(threads, estimate->useful_threads));
    double per_step = (double)estimate->particle_count / (rate * useful) + step_overhead * useful;
    return start_seconds + (double)estimate->step_count * per_step + written / frame_byte_rate;
}

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

json_t *scene_forecast(const struct talus_scene *scene, int threads, struct talus_error *error)
{
    struct talus_estimate estimate;
    if (talus_simulation_estimate(scene, &estimate, error) != TALUS_OK)
        return NULL;
    double checkpoint = (double)estimate.particle_count * (double)estimate.bytes_per_particle;
    double written =
        scene_frame_bytes(scene, (double)estimate.particle_count) + scene_history_bytes(scene);
    double copies =
        frames_in_flight * 8.0 * frame_components(scene) * (double)estimate.particle_count +
        (scene->output.checkpoint_every > 0.0 ? checkpoint : 0.0);
    double memory = (double)estimate.memory_bytes + process_bytes + copies;
    double wall = wall_seconds(scene, &estimate, threads, written);
    json_t *forecast = json_pack(
        "{s:o, s:o, s:f, s:f, s:o, s:o, s:o, s:o, s:o, s:i, s:{s:f, s:f, s:f}}", "particles",
        whole((double)estimate.particle_count), "active_cells",
        whole((double)estimate.active_cell_count), "critical_time_step",
        estimate.critical_time_step, "time_step", estimate.time_step, "steps",
        whole((double)estimate.step_count), "memory_bytes", whole(memory), "bytes_per_particle",
        whole((double)estimate.bytes_per_particle), "disk_bytes", whole(written + checkpoint),
        "bodies", describe_bodies(scene), "threads", estimate.useful_threads, "wall_seconds", "low",
        wall / rate_uncertainty, "expected", wall, "high", wall * rate_uncertainty);
    if (forecast == NULL)
        (void)talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
    return forecast;
}

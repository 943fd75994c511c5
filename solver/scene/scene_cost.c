/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_cost.h"

#include "materials/material.h"
#include "scene/scene_words.h"
#include "seeding/seeding.h"
#include "shapes/shape.h"
#include "transfers/velocity_transfer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct cost_rate {
    const char *kind, *name;
    double particle[3], cell[3]; /* [ns] by number of axes */
};

static const struct cost_rate rates[] = {
#define COST_RATE(kind, name, particle_1, particle_2, particle_3, cell_1, cell_2, cell_3)          \
    {#kind, #name, {particle_1, particle_2, particle_3}, {cell_1, cell_2, cell_3}},
#include "scene/cost_rates.def"
#undef COST_RATE
};
enum { RATE_COUNT = sizeof rates / sizeof rates[0] };

/* Of single over double precision: 1.6 to 2.2 over eight cases of talus-benchmark. */
static const double single_gain = 1.8;
/* Of the older instruction sets over x86-64-v4 (docs/performance.md); others are not known. */
static const struct {
    const char *name;
    double factor;
} isa_factors[] = {{"x86-64-v4", 1.0}, {"x86-64-v3", 1.08}, {"x86-64-v2", 3.5}};
static const double isa_unknown = 2.0;

static const double step_seconds = 2e-6;       /* of a step without particles */
static const double barrier_seconds = 25e-6;   /* of a step where threads wait for each other */
static const double crossing_seconds = 0.5e-6; /* for a particle that changes cells */
static const double start_seconds = 0.015;     /* of the process, with its libraries */
static const double seed_seconds = 0.5e-6;     /* for a particle */
static const double file_seconds = 1.3e-3;     /* of a frame's file */
static const double flush_seconds = 3e-3;      /* that a file waits for a disk */
static const double flush_share = 0.3;         /* of the steps, beyond which that matters */
static const double end_files = 8.0;           /* tables, receipt, lists of frames */
static const double byte_seconds = 15e-9;      /* compressed, and its checksum */
static const double number_seconds = 0.3e-6;   /* of a history in its tables */
static const double sample_seconds = 5e-9;     /* of a row, for a particle and probe */

static const struct cost_rate *rate_find(const char *kind, const char *name)
{
    const struct cost_rate *preset = NULL;
    for (size_t index = 0; index < RATE_COUNT; index++) {
        if (strcmp(rates[index].kind, kind) != 0)
            continue;
        if (strcmp(rates[index].name, name) == 0)
            return &rates[index];
        if (strcmp(rates[index].name, "DEFAULT") == 0)
            preset = &rates[index];
    }
    return preset;
}

bool scene_cost_rate_known(const char *kind, const char *name)
{
    const struct cost_rate *rate = rate_find(kind, name);
    return rate != NULL && strcmp(rate->name, name) == 0;
}

/* [ns] of a step. */
struct step_rate {
    double particle, cell;
};

static void add_rate(struct step_rate *sum, size_t axes, const char *kind, const char *name,
                     double share)
{
    const struct cost_rate *rate = rate_find(kind, name);
    if (rate == NULL)
        return;
    sum->particle += share * rate->particle[axes - 1];
    sum->cell += share * rate->cell[axes - 1];
}

/* Every material by its share of the particles, of as many bodies as count. */
static void add_materials(struct step_rate *sum, const struct talus_scene *scene)
{
    enum { COUNTED_MAX = 100 };
    double particles[COUNTED_MAX], all = 0.0;
    for (size_t index = 0; index < scene->body_count && index < COUNTED_MAX; index++) {
        struct seeding_report report;
        seeding_report(scene, index, &report);
        particles[index] = fmax((double)report.particle_count, 1.0);
        all += particles[index];
    }
    for (size_t index = 0; index < scene->body_count && index < COUNTED_MAX; index++) {
        const struct talus_material *material =
            &scene->materials[scene->bodies[index].material_index];
        add_rate(sum, scene->axis_count, "MATERIAL", material_table[material->model_index]->name,
                 particles[index] / all);
    }
}

static double isa_factor(void)
{
    for (size_t index = 0; index < sizeof isa_factors / sizeof isa_factors[0]; index++) {
        if (strcmp(isa_factors[index].name, talus_simulation_isa()) == 0)
            return isa_factors[index].factor;
    }
    return isa_unknown;
}

static struct step_rate step_rate_make(const struct talus_scene *scene)
{
    const struct talus_solver_options *solver = &scene->solver;
    const size_t axes = scene->axis_count;
    struct step_rate rate = {0};
    char fit[64];
    (void)snprintf(fit, sizeof fit, "%s_%s", scene_control_words[solver->anti_locking],
                   solver->anti_locking_field == TALUS_FIT_VOLUMETRIC ? "volumetric" : "full");
    add_rate(&rate, axes, "BASE", "step", 1.0);
    add_rate(&rate, axes, "DIMENSION", scene_dimension_words[scene->dimension], 1.0);
    add_rate(&rate, axes, "SHAPE", shape_table[solver->shape_index]->name, 1.0);
    add_rate(&rate, axes, "TRANSFER", transfer_of(solver)->name, 1.0);
    add_rate(&rate, axes, "ANTI_LOCKING", fit, 1.0);
    add_materials(&rate, scene);
    double factor =
        isa_factor() / (solver->precision == TALUS_PRECISION_SINGLE ? single_gain : 1.0);
    rate.particle *= factor;
    rate.cell *= factor;
    return rate;
}

struct scene_cost scene_cost_make(const struct talus_scene *scene,
                                  const struct talus_estimate *estimate,
                                  const struct scene_output_size *output, int threads)
{
    const double particles = (double)estimate->particle_count;
    const struct step_rate rate = step_rate_make(scene);
    const double number_bytes = scene->output.frame_double ? 8.0 : 4.0;
    const double frame = file_seconds * (scene->output.grid_fields != 0 ? 2.0 : 1.0) +
                         byte_seconds * particles * output->frame_numbers * number_bytes;
    const double rows =
        output->row_count * (sample_seconds * particles * (1.0 + (double)scene->probe_count) +
                             number_seconds * output->column_count);
    struct scene_cost cost = {
        .threads = fmax(1.0, fmin(threads, estimate->useful_threads)),
        .step = step_seconds + 1e-9 * rate.cell * (double)estimate->active_cell_count,
        .particle_step = 1e-9 * rate.particle + crossing_seconds * estimate->crossing_share,
        .background = output->frame_count * frame,
        .files = end_files + output->frame_count * (scene->output.grid_fields != 0 ? 2.0 : 1.0),
    };
    if (cost.threads > 1.0)
        cost.step += barrier_seconds * cost.threads;
    cost.fixed = start_seconds + seed_seconds * particles + rows + cost.background;
    return cost;
}

double scene_cost_cpu(const struct scene_cost *cost, double steps, double particle_steps)
{
    return cost->fixed + steps * cost->step + particle_steps * cost->particle_step;
}

double scene_cost_wall(const struct scene_cost *cost, double steps, double particle_steps)
{
    double stepping = (steps * cost->step + particle_steps * cost->particle_step) / cost->threads;
    return cost->fixed - cost->background + fmax(stepping, cost->background);
}

bool scene_cost_is_files(const struct scene_cost *cost, double steps, double particle_steps)
{
    double stepping = (steps * cost->step + particle_steps * cost->particle_step) / cost->threads;
    return flush_seconds * cost->files > flush_share * stepping;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_advice.h"

#include "materials/material.h"
#include "seeding/seeding_lattice.h"

#include <math.h>
#include <stdio.h>

void scene_advise(struct scene_advice *advice, const char *pointer, const char *code,
                  const char *detail, const char *change, const char *saves)
{
    (void)json_array_append_new(advice->list, json_pack("{s:s, s:s, s:s, s:s, s:s}", "pointer",
                                                        pointer, "code", code, "detail", detail,
                                                        "change", change, "saves", saves));
}

void scene_advise_time_step(struct scene_advice *advice)
{
    const struct talus_estimate *estimate = advice->estimate;
    double fixed = advice->scene->solver.time_step;
    char detail[160], saves[96];
    if (estimate == NULL || fixed <= 0.0)
        return;
    double share = fixed / estimate->critical_time_step;
    double automatic = advice->scene->solver.courant;
    if (share > 1.0) {
        (void)snprintf(detail, sizeof detail,
                       "the step is %.3g times the critical one: sound outruns it", share);
        scene_advise(advice, "/solver/time_step", "over_critical", detail,
                     "a smaller step, or \"auto\"", "a run that does not blow up");
    } else if (share < 0.5 * automatic) {
        (void)snprintf(detail, sizeof detail, "the step is %.2g of the critical one, %.3g s", share,
                       estimate->critical_time_step);
        (void)snprintf(saves, sizeof saves, "a factor of %.2g in wall time", automatic / share);
        scene_advise(advice, "/solver/time_step", "small_time_step", detail,
                     "\"time_step\": \"auto\"", saves);
    }
}

void scene_advise_output(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    const double frame_limit = 500.0;
    double every = scene->output.frames_every;
    double step = advice->estimate != NULL ? advice->estimate->time_step : 0.0;
    char detail[160], change[96], saves[96];
    if (every > 0.0 && scene->duration / every > frame_limit) {
        double frames = scene->duration / every;
        (void)snprintf(detail, sizeof detail, "%.0f frames are more than anyone looks at", frames);
        (void)snprintf(change, sizeof change, "\"every\": %.3g", scene->duration / 100.0);
        (void)snprintf(saves, sizeof saves, "%.0f %% of the disk space of frames",
                       100.0 * (1.0 - 100.0 / frames));
        scene_advise(advice, "/output/frames/every", "many_frames", detail, change, saves);
    }
    if (scene->output.history_every < step) {
        (void)snprintf(detail, sizeof detail,
                       "samples every %.3g s are closer than the time step of %.3g s",
                       scene->output.history_every, step);
        (void)snprintf(change, sizeof change, "\"every\": %.3g", 10.0 * step);
        scene_advise(advice, "/output/history/every", "fine_history", detail, change,
                     "rows that say nothing new");
    }
}

/* Poisson's ratio; 0.5 for fluids. */
static double poisson_ratio(const struct talus_material *entry)
{
    double bulk, shear;
    material_elastic_moduli(material_table[entry->model_index], entry->values, &bulk, &shear);
    return (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
}

void scene_advise_locking(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    char detail[160];
    /* In plane stress what does not go into the plane goes across it. */
    if (scene->solver.anti_locking != TALUS_CONTROL_NONE || scene->axis_count < 2 ||
        scene->dimension == TALUS_PLANE_STRESS)
        return;
    for (size_t index = 0; index < scene->material_count; index++) {
        const struct material *model = material_table[scene->materials[index].model_index];
        double poisson = poisson_ratio(&scene->materials[index]);
        if (poisson <= 0.45 && !model->plastic)
            continue;
        (void)snprintf(
            detail, sizeof detail,
            poisson > 0.45
                ? "the nearly incompressible material '%.40s' locks with linear shapes"
                : "plastic flow of '%.40s' keeps its volume and locks with linear shapes",
            scene->materials[index].name);
        scene_advise(advice, "/solver/anti_locking/control", "locking", detail,
                     "\"anti_locking\": {\"control\": \"cell\", \"field\": \"volumetric\"}",
                     "errors of tens of per cent in stress and motion");
        return;
    }
}

void scene_advise_superfluous(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    if (scene->solver.anti_locking == TALUS_CONTROL_NONE)
        return;
    for (size_t index = 0; index < scene->material_count; index++) {
        const struct material *model = material_table[scene->materials[index].model_index];
        const bool stiff =
            scene->dimension != TALUS_PLANE_STRESS && poisson_ratio(&scene->materials[index]) > 0.4;
        if (model->plastic || stiff)
            return;
    }
    /* Fits of all components are against locking in bending, which every solid may do. */
    if (scene->solver.anti_locking_field != TALUS_FIT_VOLUMETRIC)
        return;
    const bool cells = scene->solver.anti_locking == TALUS_CONTROL_CELL;
    scene_advise(advice, "/solver/anti_locking/control", "superfluous_anti_locking",
                 "no material of this scene is nearly incompressible or flows plastically",
                 "\"anti_locking\": {\"control\": \"none\"}",
                 cells ? "a few per cent of the wall time" : "a third of the wall time");
}

void scene_advise_particles(struct scene_advice *advice)
{
    static const char *const keys[] = {"particles_per_cell", "spacing", "count"};
    const struct talus_scene *scene = advice->scene;
    char pointer[64], detail[160];
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        struct seeding_lattice lattice;
        double least = INFINITY;
        if (body->shape == TALUS_BODY_POINTS)
            continue;
        seeding_lattice_init(&lattice, scene, body);
        for (size_t k = 0; k < scene->axis_count; k++) {
            /* A body thinner than a cell has all its particles in it. */
            double extent = lattice.shape.max[k] - lattice.shape.min[k];
            double reach = fmin(scene->grid.cell[k], extent);
            least = fmin(least, reach / lattice.spacing[k]);
        }
        if (least >= 1.5)
            continue;
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu/%s", index, keys[body->lattice]);
        (void)snprintf(detail, sizeof detail,
                       "body '%.40s' has %.2g particles per cell on an axis: a stretch opens gaps",
                       body->name, least);
        scene_advise(advice, pointer, "few_particles", detail,
                     "at least 2 particles per cell on every axis",
                     "cells that break apart, noise in stresses");
    }
}

void scene_advise_features(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    char detail[160];
    for (size_t index = 0; index < scene->body_count; index++) {
        struct seeding_shape shape;
        seeding_shape_init(&shape, scene, &scene->bodies[index]);
        for (size_t k = 0; k < scene->axis_count; k++) {
            double cells = (shape.max[k] - shape.min[k]) / scene->grid.cell[k];
            bool channel = scene->grid.cell_count[k] <= 2; /* thin on purpose */
            if (cells > 1.5 || channel)
                continue;
            (void)snprintf(detail, sizeof detail,
                           "body '%.40s' is %.2g cells thick along %c: it cannot bend or shear",
                           scene->bodies[index].name, cells, "xyz"[k]);
            scene_advise(advice, "/grid/cell", "coarse_grid", detail,
                         "cells of a quarter of the smallest feature", "a wrong answer");
            return;
        }
    }
}

/* Cells across the smallest extent of any body or obstacle. */
static double cells_across(const struct talus_scene *scene)
{
    double least = INFINITY;
    for (size_t index = 0; index < scene->body_count; index++) {
        struct seeding_shape shape;
        seeding_shape_init(&shape, scene, &scene->bodies[index]);
        for (size_t k = 0; k < scene->axis_count; k++)
            least = fmin(least, (shape.max[k] - shape.min[k]) / scene->grid.cell[k]);
    }
    for (size_t index = 0; index < scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &scene->boundaries[index];
        for (size_t k = 0; k < scene->axis_count && boundary->shape == TALUS_BOUNDARY_BOX; k++)
            least =
                fmin(least, (boundary->box_max[k] - boundary->box_min[k]) / scene->grid.cell[k]);
    }
    return least;
}

void scene_advise_fine_grid(struct scene_advice *advice)
{
    static const double enough[] = {1000.0, 150.0, 60.0}; /* by number of axes */
    const struct talus_scene *scene = advice->scene;
    double limit = enough[scene->axis_count - 1], cells = cells_across(scene);
    char detail[160], change[96], saves[96];
    if (cells <= limit)
        return;
    (void)snprintf(detail, sizeof detail, "%.0f cells across the smallest feature", cells);
    (void)snprintf(change, sizeof change, "cells %.2g times as large", cells / limit);
    (void)snprintf(saves, sizeof saves, "a factor of about %.2g in wall time",
                   pow(cells / limit, (double)scene->axis_count + 1.0));
    scene_advise(advice, "/grid/cell", "fine_grid", detail, change, saves);
}

json_t *scene_advice(const struct talus_scene *scene)
{
    static void (*const advisers[])(struct scene_advice *) = {
        scene_advise_uniform,     scene_advise_revolution, scene_advise_mirror,
        scene_advise_time_step,   scene_advise_output,     scene_advise_locking,
        scene_advise_superfluous, scene_advise_fine_grid,  scene_advise_particles,
        scene_advise_features,
    };
    struct talus_estimate estimate;
    struct talus_error error = {.status = TALUS_OK};
    bool estimated = talus_simulation_estimate(scene, &estimate, &error) == TALUS_OK;
    struct scene_advice advice = {
        .scene = scene, .estimate = estimated ? &estimate : NULL, .list = json_array()};
    for (size_t index = 0; index < sizeof advisers / sizeof advisers[0]; index++)
        advisers[index](&advice);
    return advice.list;
}

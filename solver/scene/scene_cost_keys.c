/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/material.h"
#include "scene/scene_cost.h"
#include "scene/scene_words.h"
#include "shapes/shape.h"
#include "transfers/velocity_transfer.h"

#include <stdio.h>
#include <string.h>

static const struct material *model_of(const struct talus_scene *scene, size_t body)
{
    return material_table[scene->materials[scene->bodies[body].material_index].model_index];
}

/* The models of the bodies, in the order of their table, each once. */
static void write_models(const struct talus_scene *scene, char text[80])
{
    size_t length = 0;
    text[0] = '\0';
    for (size_t model = 0; model < material_count && length < 60; model++) {
        bool found = false;
        for (size_t body = 0; body < scene->body_count && !found; body++)
            found = model_of(scene, body) == material_table[model];
        if (found)
            length += (size_t)snprintf(text + length, 80 - length, "%s%s", length > 0 ? "+" : "",
                                       material_table[model]->name);
    }
}

/* By what decides the time of a particle: whether stress returns to a surface. */
static const char *material_class(const struct talus_scene *scene)
{
    const char *name = "fluid";
    for (size_t body = 0; body < scene->body_count; body++) {
        if (model_of(scene, body)->plastic)
            return "plastic";
        if (!model_of(scene, body)->volumetric)
            name = "elastic";
    }
    return name;
}

void scene_cost_keys_make(const struct talus_scene *scene, int threads,
                          struct scene_cost_keys *keys)
{
    const struct talus_solver_options *solver = &scene->solver;
    const char *shape = shape_table[solver->shape_index]->name;
    const char *dimension = scene_dimension_words[scene->dimension];
    char models[80], build[64];
    write_models(scene, models);
    (void)snprintf(build, sizeof build, "%s/%s", talus_simulation_isa(),
                   scene_precision_words[solver->precision]);
    (void)snprintf(keys->level[0], COST_KEY_SIZE, "%s/%s/%s/%s/%s-%s/%s/%s/%s/%d", dimension, shape,
                   transfer_of(solver)->name, scene_stress_words[solver->stress_update],
                   scene_control_words[solver->anti_locking],
                   scene_fit_words[solver->anti_locking_field], scene_strain_words[solver->strain],
                   models, build, threads);
    (void)snprintf(keys->level[1], COST_KEY_SIZE, "%s/%s/%s/%s", dimension, shape,
                   material_class(scene), build);
    (void)snprintf(keys->level[2], COST_KEY_SIZE, "%s", build);
}

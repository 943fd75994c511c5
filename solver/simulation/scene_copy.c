/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/scene_copy.h"

#include "materials/material.h"
#include "state/time_table.h"

#include <stdlib.h>
#include <string.h>

/* Copy of `bytes` bytes, or NULL with *failed set; NULL for NULL. */
static void *duplicate(const void *source, size_t bytes, bool *failed)
{
    if (source == NULL)
        return NULL;
    void *copy = malloc(bytes > 0 ? bytes : 1);
    if (copy == NULL)
        *failed = true;
    else if (bytes > 0)
        memcpy(copy, source, bytes);
    return copy;
}

static char *duplicate_text(const char *text, bool *failed)
{
    return duplicate(text, text == NULL ? 0 : strlen(text) + 1, failed);
}

/* Arrays first: a count is only set together with its array, so that release stays safe. */
static void copy_materials(const struct talus_scene *scene, struct talus_scene *copy, bool *failed)
{
    copy->materials = calloc(scene->material_count + 1, sizeof *copy->materials);
    *failed = *failed || copy->materials == NULL;
    for (size_t index = 0; !*failed && index < scene->material_count; index++) {
        const struct talus_material *source = &scene->materials[index];
        struct talus_material *material = &copy->materials[copy->material_count++];
        const size_t values = material_parameters(material_table[source->model_index], NULL, 0);
        material->model_index = source->model_index;
        material->name = duplicate_text(source->name, failed);
        material->values = duplicate(source->values, values * sizeof(double), failed);
    }
}

/* Everything a body owns; `copy` holds its plain members. */
static void copy_body(const struct talus_body *body, struct talus_body *copy, bool *failed)
{
    const size_t number = sizeof(double);
    copy->name = duplicate_text(body->name, failed);
    copy->vertices = duplicate(body->vertices, 2 * body->vertex_count * number, failed);
    copy->point_positions =
        duplicate(body->point_positions, 3 * body->point_count * number, failed);
    copy->point_volumes = duplicate(body->point_volumes, body->point_count * number, failed);
    copy->tractions =
        duplicate(body->tractions, body->traction_count * sizeof *body->tractions, failed);
    for (size_t index = 0; copy->tractions != NULL && index < body->traction_count; index++)
        *failed |= time_table_duplicate(copy->tractions[index].table, 3) != 0;
    if (copy->tractions == NULL)
        copy->traction_count = 0;
}

static void copy_named(const struct talus_scene *scene, struct talus_scene *copy, bool *failed)
{
    copy->bodies = duplicate(scene->bodies, scene->body_count * sizeof *scene->bodies, failed);
    for (size_t index = 0; copy->bodies != NULL && index < scene->body_count; index++) {
        copy_body(&scene->bodies[index], &copy->bodies[index], failed);
        copy->body_count++;
    }
    copy->boundaries =
        duplicate(scene->boundaries, scene->boundary_count * sizeof *scene->boundaries, failed);
    for (size_t index = 0; copy->boundaries != NULL && index < scene->boundary_count; index++) {
        copy->boundaries[index].name = duplicate_text(scene->boundaries[index].name, failed);
        if (time_table_duplicate(copy->boundaries[index].velocity_tables, 3) != 0)
            *failed = true;
        copy->boundary_count++;
    }
    copy->probes = duplicate(scene->probes, scene->probe_count * sizeof *scene->probes, failed);
    for (size_t index = 0; copy->probes != NULL && index < scene->probe_count; index++) {
        copy->probes[index].name = duplicate_text(scene->probes[index].name, failed);
        copy->probe_count++;
    }
}

int scene_copy(const struct talus_scene *scene, struct talus_scene *copy)
{
    bool failed = false;
    *copy = *scene;
    copy->materials = NULL;
    copy->bodies = NULL;
    copy->boundaries = NULL;
    copy->probes = NULL;
    copy->references = NULL; /* compared outside of the solver */
    copy->material_count = copy->body_count = copy->boundary_count = 0;
    copy->probe_count = copy->reference_count = 0;
    copy->slopes = duplicate(scene->slopes, scene->slope_count * sizeof *scene->slopes, &failed);
    failed |= time_table_duplicate(copy->gravity_table, 3) != 0;
    copy->title = duplicate_text(scene->title, &failed);
    copy_materials(scene, copy, &failed);
    copy_named(scene, copy, &failed);
    if (!failed)
        return 0;
    talus_scene_release(copy);
    return -1;
}

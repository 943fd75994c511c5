/* SPDX-License-Identifier: Apache-2.0 */
#include "talus/scene.h"

#include "state/time_table.h"

#include <stdlib.h>
#include <string.h>

static void release_body(struct talus_body *body)
{
    for (size_t index = 0; index < body->traction_count; index++)
        time_table_release(body->tractions[index].table, 3);
    free(body->name);
    free(body->vertices);
    free(body->point_positions);
    free(body->point_volumes);
    free(body->tractions);
}

void talus_scene_release(struct talus_scene *scene)
{
    for (size_t index = 0; index < scene->material_count; index++) {
        free(scene->materials[index].name);
        free(scene->materials[index].values);
    }
    for (size_t index = 0; index < scene->body_count; index++)
        release_body(&scene->bodies[index]);
    for (size_t index = 0; index < scene->boundary_count; index++) {
        free(scene->boundaries[index].name);
        time_table_release(scene->boundaries[index].velocity_tables, 3);
    }
    for (size_t index = 0; index < scene->probe_count; index++)
        free(scene->probes[index].name);
    for (size_t index = 0; index < scene->reference_count; index++) {
        free(scene->references[index].name);
        free(scene->references[index].time);
        free(scene->references[index].value);
        free(scene->references[index].of_job);
    }
    time_table_release(scene->gravity_table, 3);
    free(scene->slopes);
    free(scene->materials);
    free(scene->bodies);
    free(scene->boundaries);
    free(scene->probes);
    free(scene->references);
    free(scene->title);
    memset(scene, 0, sizeof *scene);
}

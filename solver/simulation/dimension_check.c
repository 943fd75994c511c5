/* SPDX-License-Identifier: Apache-2.0 */
/* What plane stress and bodies of revolution cannot have. */
#include "simulation/simulation_private.h"

#include <stdio.h>
#include <string.h>

/* sigma_zz = 0 fixes e_zz only where stress is linear in strain; plastic flow would need an
 * iteration of its own (Mast 2013, sec. B.2.2 allows linear elasticity only). */
static enum talus_status check_plane_stress(const struct talus_scene *scene,
                                            struct talus_error *error)
{
    char pointer[160];
    for (size_t index = 0; index < scene->material_count; index++) {
        const struct talus_material *material = &scene->materials[index];
        const char *model = material_table[material->model_index]->name;
        if (strcmp(model, "linear_elastic") == 0)
            continue;
        (void)snprintf(pointer, sizeof pointer, "/materials/%.120s/model", material->name);
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "plane stress is for linear_elastic materials only: the strain that "
                               "makes sigma_zz zero is not known for %s; use \"plane_strain\" or "
                               "\"solid\"",
                               model);
    }
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        if (body->initial_stress != TALUS_INITIAL_GIVEN || body->stress[2] == 0)
            continue;
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu/initial_stress/2", index);
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "in plane stress the component zz is zero");
    }
    return TALUS_OK;
}

static enum talus_status check_revolution(const struct talus_scene *scene,
                                          struct talus_error *error)
{
    if (scene->grid.min[0] < 0)
        return talus_error_set(error, TALUS_INVALID, "dimension", "/grid/min/0",
                               "x is the distance from the axis in an axisymmetric scene: the grid "
                               "cannot begin at %g m",
                               scene->grid.min[0]);
    if (scene->slope_count > 0)
        return talus_error_set(error, TALUS_INVALID, "contradiction", "/gravity/slopes",
                               "in an axisymmetric scene gravity acts along the axis, y, only");
    if (scene->gravity[0] != 0 || scene->gravity_table[0].count > 0)
        return talus_error_set(error, TALUS_INVALID, "contradiction", "/gravity/0",
                               "in an axisymmetric scene gravity acts along the axis, y, only");
    for (size_t index = 0; index < scene->body_count; index++) {
        char pointer[64];
        if (scene->bodies[index].velocity_field == TALUS_VELOCITY_UNIFORM)
            continue;
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu/velocity", index);
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "a body of revolution neither rotates in its section nor bends as a "
                               "beam: give a velocity (along r and the axis)");
    }
    return TALUS_OK;
}

enum talus_status scene_check_dimension(const struct talus_scene *scene, struct talus_error *error)
{
    if (scene->dimension == TALUS_PLANE_STRESS)
        return check_plane_stress(scene, error);
    if (scene->dimension == TALUS_AXISYMMETRIC)
        return check_revolution(scene, error);
    return TALUS_OK;
}

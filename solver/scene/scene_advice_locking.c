/* SPDX-License-Identifier: Apache-2.0 */
/* Averages against locking: missing, superfluous, or of a kind that spoils the material. */
#include "scene/scene_advice.h"
#include "scene/scene_geometry.h"

#include "materials/material.h"
#include "shapes/shape.h"

#include <stdio.h>

static const struct material *model_of(const struct talus_material *material)
{
    return material_table[material->model_index];
}

/* In plane stress what does not go into the plane goes across it, and on a line nothing is
 * constrained. */
static bool may_lock(const struct talus_scene *scene)
{
    return scene->axis_count >= 2 && scene->dimension != TALUS_PLANE_STRESS;
}

/* Within one cell there is one state, which nothing constrains. */
static bool is_one_cell(const struct talus_scene *scene, const struct talus_body *body)
{
    bool one = true;
    double low[3], high[3];
    scene_body_bounds(scene, body, low, high);
    for (size_t k = 0; k < scene->axis_count; k++)
        one = one && high[k] - low[k] <= 1.5 * scene->grid.cell[k];
    return one;
}

void scene_advise_locking(struct scene_advice *advice)
{
    const double nearly = 0.45;
    const struct talus_scene *scene = advice->scene;
    const struct shape *shape = shape_table[scene->solver.shape_index];
    char detail[160];
    if (scene->solver.anti_locking != TALUS_CONTROL_NONE || !may_lock(scene) || !shape->locks)
        return;
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        const struct talus_material *material = &scene->materials[body->material_index];
        const bool stiff = scene_poisson_ratio(material) > nearly;
        if ((!stiff && !model_of(material)->plastic) || is_one_cell(scene, body))
            continue;
        (void)snprintf(detail, sizeof detail,
                       stiff ? "the nearly incompressible material '%.40s' locks with the shape %s"
                             : "plastic flow of '%.40s' keeps its volume and locks with the shape "
                               "%s",
                       material->name, shape->name);
        scene_advise(advice,
                     &(struct scene_advice_item){
                         .pointer = "/solver/anti_locking/control",
                         .code = "locking",
                         .detail = detail,
                         .change = "\"anti_locking\": {\"control\": \"cell\", \"field\": "
                                   "\"volumetric\"}, or the default shape, \"bspline2\", which "
                                   "locks less",
                         .saves = "errors of 10 per cent and more in motion and loads",
                         .set = json_pack("{s:s, s:s}", "/solver/anti_locking/control", "cell",
                                          "/solver/anti_locking/field", "volumetric"),
                     });
        return;
    }
}

/* True if a material of the scene can lock. */
static bool any_locks(const struct talus_scene *scene)
{
    const double compressible = 0.4;
    for (size_t index = 0; index < scene->body_count && may_lock(scene); index++) {
        const struct talus_material *material =
            &scene->materials[scene->bodies[index].material_index];
        if (model_of(material)->plastic || scene_poisson_ratio(material) > compressible)
            return true;
    }
    return false;
}

void scene_advise_superfluous(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    /* Fits of all components are against locking in bending, which every solid may do. */
    if (scene->solver.anti_locking == TALUS_CONTROL_NONE || any_locks(scene) ||
        (scene->solver.anti_locking_field != TALUS_FIT_VOLUMETRIC && scene->axis_count >= 2))
        return;
    const bool cells = scene->solver.anti_locking == TALUS_CONTROL_CELL;
    scene_advise(
        advice,
        &(struct scene_advice_item){
            .pointer = "/solver/anti_locking/control",
            .code = "superfluous_anti_locking",
            .detail = scene->axis_count < 2
                          ? "nothing locks on a line"
                          : "no material of this scene is nearly incompressible or flows "
                            "plastically",
            .change = "\"anti_locking\": {\"control\": \"none\"}",
            .saves = cells
                         ? "5 to 10 per cent of the wall time, and softness in bending"
                         : "a third to a half of the wall time, and elastic strain that wears down",
            .set = json_pack("{s:s, s:s}", "/solver/anti_locking/control", "none",
                             "/solver/anti_locking/field", "volumetric"),
        });
}

void scene_advise_averaging(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    const enum talus_anti_locking_control control = scene->solver.anti_locking;
    char detail[160];
    /* What nothing can lock in is told to do without. */
    if ((control != TALUS_CONTROL_NODE && control != TALUS_CONTROL_HYBRID) || !any_locks(scene))
        return;
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_material *material =
            &scene->materials[scene->bodies[index].material_index];
        if (model_of(material)->volumetric || model_of(material)->plastic)
            continue;
        (void)snprintf(detail, sizeof detail,
                       "means over nodes, renewed in every step, wear down the elastic strain of "
                       "'%.40s'",
                       material->name);
        scene_advise(advice, &(struct scene_advice_item){
                                 .pointer = "/solver/anti_locking/control",
                                 .code = "averaged_elastic_strain",
                                 .detail = detail,
                                 .change = "\"control\": \"cell\"",
                                 .saves = "a wrong answer wherever elastic strain has to last",
                                 .set = json_pack("{s:s}", "/solver/anti_locking/control", "cell"),
                             });
        return;
    }
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Cells across the features of a scene, and particles in the cells. */
#include "scene/scene_advice.h"
#include "scene/scene_feature.h"

#include "seeding/seeding_lattice.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A list of at least two particles a cell, in the way that the body says it. */
static json_t *denser(const struct talus_scene *scene, const struct talus_body *body,
                      const struct seeding_lattice *lattice)
{
    json_t *list = json_array();
    for (size_t k = 0; k < scene->axis_count; k++) {
        const double half = 0.5 * scene->grid.cell[k], given = body->lattice_value[k];
        const double extent = lattice->shape.max[k] - lattice->shape.min[k];
        double value = 0.0;
        switch (body->lattice) {
        case TALUS_LATTICE_PER_CELL:
            value = fmax(2.0, given);
            break;
        case TALUS_LATTICE_SPACING:
            value = fmin(half, given);
            break;
        case TALUS_LATTICE_COUNT:
            value = fmax(ceil(extent / half - 1e-9), given);
            break;
        }
        (void)json_array_append_new(list, value == floor(value) ? json_integer((json_int_t)value)
                                                                : json_real(value));
    }
    return list;
}

/* Particles of a cell along the axis that has the fewest; a body thinner than a cell has all its
 * particles in it. */
static double fewest(const struct talus_scene *scene, const struct seeding_lattice *lattice)
{
    double least = INFINITY;
    for (size_t k = 0; k < scene->axis_count; k++) {
        const double extent = lattice->shape.max[k] - lattice->shape.min[k];
        least = fmin(least, fmin(scene->grid.cell[k], extent) / lattice->spacing[k]);
    }
    return least;
}

void scene_advise_particles(struct scene_advice *advice)
{
    enum { SHOWN_MAX = 8 };
    static const char *const keys[] = {"particles_per_cell", "spacing", "count"};
    const struct talus_scene *scene = advice->scene;
    char pointer[64], detail[160];
    for (size_t index = 0, shown = 0; index < scene->body_count && shown < SHOWN_MAX; index++) {
        const struct talus_body *body = &scene->bodies[index];
        struct seeding_lattice lattice;
        if (body->shape == TALUS_BODY_POINTS)
            continue;
        seeding_lattice_init(&lattice, scene, body);
        const double least = fewest(scene, &lattice);
        /* One particle is no lattice: it is there to be followed, or one of many such bodies. */
        if (least >= 1.5 || seeding_lattice_point_count(&lattice) < 2.0)
            continue;
        shown++;
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu/%s", index, keys[body->lattice]);
        (void)snprintf(detail, sizeof detail,
                       "body '%.40s' has %.2g particles per cell on an axis: a stretch opens gaps",
                       body->name, least);
        scene_advise(advice, &(struct scene_advice_item){
                                 .pointer = pointer,
                                 .code = "few_particles",
                                 .detail = detail,
                                 .change = "at least 2 particles per cell on every axis",
                                 .saves = "cells that break apart, noise in stresses",
                                 .set = json_pack("{s:o}", pointer, denser(scene, body, &lattice)),
                             });
    }
}

/* The cells as one number or a vector, times a factor. */
static json_t *scaled_cells(const struct talus_scene *scene, double factor)
{
    json_t *list = json_array();
    bool equal = true;
    for (size_t k = 0; k < scene->axis_count; k++) {
        equal = equal && scene->grid.cell[k] == scene->grid.cell[0];
        (void)json_array_append_new(list, json_real(scene->grid.cell[k] * factor));
    }
    if (!equal)
        return list;
    json_decref(list);
    return json_real(scene->grid.cell[0] * factor);
}

void scene_advise_coarse_grid(struct scene_advice *advice)
{
    const double wanted = 4.0;
    const struct scene_feature feature = scene_smallest_feature(advice->scene);
    char detail[192], change[96];
    if (feature.cells > feature.least)
        return;
    const double parts = ceil(wanted / feature.cells * (1.0 - 1e-9));
    (void)snprintf(detail, sizeof detail, "%s '%.40s' is %.2g cells %s along %c: %s", feature.kind,
                   feature.name, feature.cells,
                   strcmp(feature.kind, "opening at") == 0 ? "wide" : "thick", "xyz"[feature.axis],
                   feature.consequence);
    (void)snprintf(change, sizeof change, "cells of a quarter of it: %.0f times smaller", parts);
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = "/grid/cell",
                             .code = "coarse_grid",
                             .detail = detail,
                             .change = change,
                             .saves = "a wrong answer",
                             .set = json_pack("{s:o}", "/grid/cell",
                                              scaled_cells(advice->scene, 1.0 / parts)),
                         });
}

void scene_advise_fine_grid(struct scene_advice *advice)
{
    static const double enough[] = {1000.0, 150.0, 60.0}; /* by number of axes */
    const struct talus_scene *scene = advice->scene;
    const struct scene_feature feature = scene_smallest_feature(scene);
    const double limit = enough[scene->axis_count - 1];
    char detail[160], change[96], saves[96];
    if (!isfinite(feature.cells) || feature.cells < 2.0 * limit)
        return;
    const double times = floor(feature.cells / limit);
    double factor = times; /* steps */
    bool per_cell = true;  /* other lattices do not follow the cells */
    for (size_t k = 0; k < scene->axis_count; k++)
        factor *= times;
    for (size_t index = 0; index < scene->body_count; index++)
        per_cell = per_cell && scene->bodies[index].lattice == TALUS_LATTICE_PER_CELL &&
                   scene->bodies[index].shape != TALUS_BODY_POINTS;
    (void)snprintf(detail, sizeof detail, "%.0f cells across the smallest feature, %s '%.40s'",
                   feature.cells, feature.kind, feature.name);
    (void)snprintf(change, sizeof change, "cells %.0f times as large%s", times,
                   per_cell ? "" : ", and the lattices of bodies with them");
    (void)snprintf(saves, sizeof saves, "a factor of about %.2g in particle-steps and wall time",
                   factor);
    scene_advise(
        advice,
        &(struct scene_advice_item){
            .pointer = "/grid/cell",
            .code = "fine_grid",
            .detail = detail,
            .change = change,
            .saves = saves,
            .set = per_cell ? json_pack("{s:o}", "/grid/cell", scaled_cells(scene, times)) : NULL,
            .quantity = "particle_steps",
            .factor = factor,
        });
}

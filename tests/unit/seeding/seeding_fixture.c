/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding_fixture.h"

#include <math.h>
#include <string.h>

void fixture_set(struct seeding_fixture *fixture, const char *key, double value)
{
    const struct material *model = material_table[fixture->material.model_index];
    fixture->values[material_parameter_index(model, key)] = value;
}

static void init_body(struct talus_body *body, size_t axis_count)
{
    static char name[] = "block";
    body->name = name;
    body->surface = NAN;
    for (size_t k = 0; k < 3; k++) {
        body->clip_min[k] = -INFINITY;
        body->clip_max[k] = INFINITY;
        body->box_max[k] = k < axis_count ? 1.0 : 0.0;
        body->lattice_value[k] = 2.0;
    }
}

void fixture_init(struct seeding_fixture *fixture, size_t axis_count, const char *model)
{
    memset(fixture, 0, sizeof *fixture);
    struct talus_scene *scene = &fixture->scene;
    scene->axis_count = axis_count;
    static const enum talus_dimension dimensions[] = {TALUS_LINE, TALUS_PLANE_STRAIN, TALUS_SOLID};
    scene->dimension = dimensions[axis_count - 1];
    scene->duration = 1.0;
    for (size_t k = 0; k < 3; k++) {
        scene->grid.cell[k] = k < axis_count ? 0.25 : 1.0;
        scene->grid.min[k] = k < axis_count ? -10.0 : 0.0;
        scene->grid.cell_count[k] = k < axis_count ? 80 : 1;
    }
    for (size_t index = 0; index < FIXTURE_BODY_MAX; index++)
        init_body(&fixture->bodies[index], axis_count);
    scene->bodies = fixture->bodies;
    scene->body_count = 1;
    scene->materials = &fixture->material;
    scene->material_count = 1;
    fixture->material.values = fixture->values;
    while (strcmp(material_table[fixture->material.model_index]->name, model) != 0)
        fixture->material.model_index++;
    const struct parameter *parameters[MATERIAL_PARAMETER_MAX];
    const size_t count = material_parameters(material_table[fixture->material.model_index],
                                             parameters, MATERIAL_PARAMETER_MAX);
    for (size_t index = 0; index < count; index++)
        fixture->values[index] = parameters[index]->default_value;
    fixture_set(fixture, "density", 2000.0);
    fixture_set(fixture, "young_modulus", 1e7);
    fixture_set(fixture, "poisson_ratio", 0.25);
}

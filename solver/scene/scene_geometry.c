/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_geometry.h"

#include "materials/material.h"
#include "scene/scene_condition.h"
#include "seeding/seeding_shape.h"

#include <math.h>
#include <string.h>

bool scene_near(double a, double b, double scale)
{
    return a == b || fabs(a - b) <= 1e-9 * scale;
}

void scene_body_bounds(const struct talus_scene *scene, const struct talus_body *body,
                       double min[3], double max[3])
{
    struct seeding_shape shape;
    seeding_shape_init(&shape, scene, body);
    seeding_shape_bounds(&shape, min, max);
}

bool scene_plane_is_at(const struct talus_scene *scene, const struct talus_boundary *boundary,
                       size_t axis, double place, int side)
{
    return boundary->shape == TALUS_BOUNDARY_PLANE && side * boundary->normal[axis] > 1.0 - 1e-9 &&
           fabs(boundary->point[axis] - place) <= 0.5 * scene->grid.cell[axis];
}

bool scene_mirror_is_at(const struct talus_scene *scene, const struct talus_boundary *boundary,
                        size_t axis, double place, int side)
{
    return scene_plane_is_at(scene, boundary, axis, place, side) && !boundary->timed &&
           !boundary->tension_release && boundary->body_index < 0 &&
           strcmp(scene_condition_name(boundary->faces[0].condition_index), "slip") == 0;
}

double scene_face_half(const struct talus_boundary *face, size_t axis)
{
    return 0.5 *
           (fabs(face->axis_1[axis]) * face->size[0] + fabs(face->axis_2[axis]) * face->size[1]);
}

static double moduli(const struct talus_material *entry, double *bulk, double *shear)
{
    material_elastic_moduli(material_table[entry->model_index], entry->values, bulk, shear);
    return entry->values[MATERIAL_VALUE_DENSITY];
}

double scene_wave_speed(const struct talus_material *material)
{
    double bulk, shear, density = moduli(material, &bulk, &shear);
    return sqrt((bulk + 4.0 / 3.0 * shear) / density);
}

double scene_poisson_ratio(const struct talus_material *material)
{
    double bulk, shear;
    (void)moduli(material, &bulk, &shear);
    return (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
}

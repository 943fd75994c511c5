/* SPDX-License-Identifier: Apache-2.0 */
#include "seeding/seeding_stress.h"
#include "materials/material.h"
#include "seeding/seeding.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double radians_per_degree = 3.14159265358979323846 / 180.0;

enum talus_axis seeding_vertical_axis(const struct talus_scene *scene)
{
    enum talus_axis vertical = TALUS_NO_AXIS;
    double largest = 0.0;
    for (int k = 0; k < (int)scene->axis_count; k++) {
        if (fabs(scene->gravity[k]) > largest) {
            largest = fabs(scene->gravity[k]);
            vertical = (enum talus_axis)k;
        }
    }
    return vertical;
}

double seeding_k0(const struct talus_scene *scene, const struct talus_body *body)
{
    if (body->k0_rule == TALUS_K0_GIVEN)
        return body->k0;
    const struct talus_material *entry = &scene->materials[body->material_index];
    const struct material *model = material_table[entry->model_index];
    double bulk, shear;
    material_elastic_moduli(model, entry->values, &bulk, &shear);
    /* nu / (1 - nu) = (3 K - 2 G) / (3 K + 4 G): no lateral strain in an elastic half space */
    double elastic = (3.0 * bulk - 2.0 * shear) / (3.0 * bulk + 4.0 * shear);
    double angle = material_initial_friction_angle_deg(model, entry->values);
    double sine = sin(angle * radians_per_degree);
    if (body->k0_rule == TALUS_K0_ELASTIC)
        return elastic;
    if (body->k0_rule == TALUS_K0_JAKY)
        return 1.0 - sine; /* Andersen 2012, eq. 51 */
    /* Below the active earth pressure coefficient the state would violate Mohr-Coulomb's limit. */
    double active = angle > 0.0 ? (1.0 - sine) / (1.0 + sine) : 0.0;
    return fmax(elastic, active);
}

enum talus_status seeding_stress_init(struct seeding_stress *stress,
                                      const struct talus_scene *scene, size_t body_index,
                                      const struct seeding_shape *shape, struct talus_error *error)
{
    const struct talus_body *body = &scene->bodies[body_index];
    memset(stress, 0, sizeof *stress);
    stress->shape = shape;
    stress->plane = scene->dimension == TALUS_PLANE_STRESS;
    if (body->initial_stress != TALUS_INITIAL_HYDROSTATIC &&
        body->initial_stress != TALUS_INITIAL_GEOSTATIC)
        return TALUS_OK;
    stress->vertical = seeding_vertical_axis(scene);
    if (stress->vertical == TALUS_NO_AXIS) {
        char pointer[64];
        (void)snprintf(pointer, sizeof pointer, "/bodies/%zu/initial_stress", body_index);
        return talus_error_set(error, TALUS_INVALID, "contradiction", pointer,
                               "a stress that grows with depth needs gravity");
    }
    const struct talus_material *entry = &scene->materials[body->material_index];
    double gravity = scene->gravity[stress->vertical];
    stress->weight = entry->values[MATERIAL_VALUE_DENSITY] * fabs(gravity);
    stress->up = gravity < 0.0 ? 1.0 : -1.0;
    stress->lateral =
        body->initial_stress == TALUS_INITIAL_HYDROSTATIC ? 1.0 : seeding_k0(scene, body);
    return TALUS_OK;
}

/* Depth [m] below the given surface or below the top of the body over this point. */
static double depth_at(const struct seeding_stress *stress, const double position[3])
{
    const struct talus_body *body = stress->shape->body;
    double place = position[stress->vertical];
    if (body->initial_stress == TALUS_INITIAL_HYDROSTATIC && !isnan(body->surface))
        return fmax(0.0, stress->up * (body->surface - place));
    double world[3] = {0.0, 0.0, 0.0}, direction[3], point[3];
    struct seeding_line line;
    world[stress->vertical] = 1.0;
    seeding_shape_direction(stress->shape, world, direction);
    seeding_shape_from_world(stress->shape, position, point);
    seeding_shape_line(stress->shape, point, direction, &line);
    for (size_t k = 0; k < line.count; k++) {
        const double hair = 1e-9 * (line.offset[k][1] - line.offset[k][0]);
        if (line.offset[k][0] > hair || line.offset[k][1] < -hair)
            continue; /* material beyond a hole does not rest on this one */
        const double top = place + line.offset[k][stress->up > 0.0 ? 1 : 0];
        return fmax(0.0, stress->up * (top - place));
    }
    return 0.0; /* a point on the surface, by rounding */
}

void seeding_stress_at(const struct seeding_stress *stress, const double position[3],
                       double value[6])
{
    const struct talus_body *body = stress->shape->body;
    memset(value, 0, 6 * sizeof *value);
    if (body->initial_stress == TALUS_INITIAL_GIVEN) {
        memcpy(value, body->stress, 6 * sizeof *value);
    } else if (body->initial_stress != TALUS_INITIAL_NONE) {
        double vertical = -(stress->weight * depth_at(stress, position) + body->surcharge);
        for (size_t k = 0; k < 3; k++)
            value[k] =
                (enum talus_axis)k == stress->vertical ? vertical : stress->lateral * vertical;
    }
    if (stress->plane)
        value[2] = 0.0;
}

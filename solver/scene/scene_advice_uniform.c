/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes in which nothing changes along an axis: dimensions that can be left out. */
#include "scene/scene_advice.h"
#include "scene/scene_geometry.h"

#include "seeding/seeding_lattice.h"

#include <math.h>
#include <stdio.h>

static bool near(const struct talus_scene *scene, size_t axis, double a, double b)
{
    return scene_near(a, b, scene->grid.cell[axis]);
}

static bool gravity_is_uniform(const struct talus_scene *scene, size_t axis)
{
    bool uniform = scene->gravity[axis] == 0.0 && scene->gravity_table[axis].count == 0;
    for (size_t index = 0; index < scene->slope_count; index++)
        uniform = uniform && scene->slopes[index].along[axis] == 0.0 &&
                  !isnan(scene->slopes[index].below);
    return uniform;
}

/* Loads that neither push along the axis nor act on an end. */
static bool tractions_are_uniform(const struct talus_body *body, size_t axis)
{
    for (size_t index = 0; index < body->traction_count; index++) {
        const struct talus_traction *traction = &body->tractions[index];
        const bool end =
            body->shape == TALUS_BODY_BOX ? traction->face / 2 == axis : traction->face > 0;
        if (end || (!traction->is_pressure && traction->value[axis] != 0.0) ||
            (!traction->is_pressure && traction->table[axis].count > 0))
            return false;
    }
    return true;
}

static bool motion_is_uniform(const struct talus_body *body, size_t axis)
{
    if (body->velocity_field == TALUS_VELOCITY_BEAM_MODE || body->velocity[axis] != 0.0)
        return false;
    for (size_t k = 0; k < 3 && body->velocity_field == TALUS_VELOCITY_ROTATION; k++) {
        if (k != axis && body->rotation_rate[k] != 0.0)
            return false;
    }
    return true;
}

/* No shear with the axis: components xx yy zz xy yz xz. */
static bool stress_is_uniform(const struct talus_body *body, size_t axis)
{
    static const size_t shears[3][2] = {{3, 5}, {3, 4}, {4, 5}};
    return body->initial_stress != TALUS_INITIAL_GIVEN ||
           (body->stress[shears[axis][0]] == 0.0 && body->stress[shears[axis][1]] == 0.0);
}

/* True if the body is the same everywhere between its two ends on the axis, which go to range. */
static bool body_is_uniform(const struct talus_scene *scene, const struct talus_body *body,
                            size_t axis, double range[2])
{
    struct seeding_shape shape;
    seeding_shape_init(&shape, scene, body);
    range[0] = shape.min[axis];
    range[1] = shape.max[axis];
    bool uniform = body->shape == TALUS_BODY_BOX || body->shape == TALUS_BODY_CYLINDER;
    for (size_t k = 0; k < 3 && body->shape == TALUS_BODY_CYLINDER; k++)
        uniform = uniform && (k == axis || near(scene, k, body->from[k], body->to[k]));
    return uniform && (!shape.turned || shape.turn[axis][axis] > 1.0 - 1e-12) &&
           tractions_are_uniform(body, axis) && motion_is_uniform(body, axis) &&
           stress_is_uniform(body, axis);
}

/* True if the boundary looks the same at every place of the range on the axis. */
static bool boundary_is_uniform(const struct talus_scene *scene,
                                const struct talus_boundary *boundary, size_t axis,
                                const double range[2])
{
    const double along = fabs(boundary->normal[axis]);
    if (boundary->velocity[axis] != 0.0 || boundary->velocity_tables[axis].count > 0)
        return false;
    if (boundary->shape == TALUS_BOUNDARY_BOX)
        return boundary->box_min[axis] <= range[0] && boundary->box_max[axis] >= range[1];
    if (along > 1.0 - 1e-9)
        return scene_mirror_is_at(scene, boundary, axis, range[0], 1) ||
               scene_mirror_is_at(scene, boundary, axis, range[1], -1);
    if (along > 1e-9)
        return false;
    const double half = scene_face_half(boundary, axis);
    return boundary->shape == TALUS_BOUNDARY_PLANE ||
           (boundary->point[axis] - half <= range[0] && boundary->point[axis] + half >= range[1]);
}

/* Free ends move: only between walls is nothing happening along the axis. */
static bool has_ends(const struct talus_scene *scene, size_t axis, const double range[2])
{
    bool low = false, high = false;
    for (size_t index = 0; index < scene->boundary_count; index++) {
        low |= scene_mirror_is_at(scene, &scene->boundaries[index], axis, range[0], 1);
        high |= scene_mirror_is_at(scene, &scene->boundaries[index], axis, range[1], -1);
    }
    return low && high;
}

static bool axis_is_uniform(const struct talus_scene *scene, size_t axis)
{
    double range[2] = {0.0, 0.0};
    if (!gravity_is_uniform(scene, axis) || scene->body_count == 0)
        return false;
    for (size_t index = 0; index < scene->body_count; index++) {
        double own[2];
        if (!body_is_uniform(scene, &scene->bodies[index], axis, own))
            return false;
        if (index > 0 &&
            (!near(scene, axis, own[0], range[0]) || !near(scene, axis, own[1], range[1])))
            return false;
        range[0] = own[0];
        range[1] = own[1];
    }
    for (size_t index = 0; index < scene->boundary_count; index++) {
        if (!boundary_is_uniform(scene, &scene->boundaries[index], axis, range))
            return false;
    }
    return has_ends(scene, axis, range);
}

/* Particles now over those of the scene without these axes. */
static double particle_factor(const struct talus_scene *scene, unsigned axes)
{
    double now = 0.0, left = 0.0;
    for (size_t index = 0; index < scene->body_count; index++) {
        struct seeding_lattice lattice;
        seeding_lattice_init(&lattice, scene, &scene->bodies[index]);
        double layers = 1.0;
        for (size_t k = 0; k < scene->axis_count; k++)
            layers *= (axes >> k & 1u) != 0 ? lattice.count[k] : 1.0;
        now += seeding_lattice_point_count(&lattice);
        left += seeding_lattice_point_count(&lattice) / layers;
    }
    return now / left;
}

void scene_advise_uniform(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    const bool solid = scene->dimension == TALUS_SOLID;
    unsigned axes = 0;
    size_t count = 0, most = solid ? 2 : 1;
    char names[8] = "", detail[96], saves[160];
    for (size_t axis = 0; axis < scene->axis_count && count < most; axis++) {
        if (!axis_is_uniform(scene, axis))
            continue;
        axes |= 1u << axis;
        count++;
        (void)snprintf(names, sizeof names, count == 1 ? "%c" : "x and %c", "xyz"[axis]);
        if (count == 2 && (axes & 1u) == 0)
            (void)snprintf(names, sizeof names, "y and z");
    }
    advice->settled_axes |= axes;
    /* There is no dimension without the axis: it is a slice already. */
    if (count == 0 || (!solid && scene->dimension != TALUS_PLANE_STRAIN))
        return;
    const double factor = particle_factor(scene, axes);
    const bool line = !solid || count == 2;
    (void)snprintf(detail, sizeof detail, "nothing in this scene changes along %s", names);
    (void)snprintf(
        saves, sizeof saves,
        "a factor of %.3g in particles, twice that in the time of long runs (extensive results are "
        "then per %s)",
        factor, line ? "square metre" : "metre");
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = "/dimension",
                             .code = "uniform_axis",
                             .detail = detail,
                             .change = line ? "\"dimension\": \"line\", along the other axis"
                                            : "\"dimension\": \"plane_strain\", without that axis",
                             .saves = saves,
                             .quantity = "particle_steps",
                             .factor = factor,
                         });
}

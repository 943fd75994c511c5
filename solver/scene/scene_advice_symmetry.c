/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes that repeat themselves: uniform along an axis, or equal to their mirror image. */
#include "scene/scene_advice.h"
#include "scene/scene_condition.h"

#include "seeding/seeding_shape.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool near(double a, double b, double scale)
{
    return a == b || fabs(a - b) <= 1e-9 * scale;
}

static bool near_scaled(const struct talus_scene *scene, size_t axis, double a, double b)
{
    return near(a, b, scene->grid.cell[axis]);
}

/* True if gravity has a component on the axis somewhere, or depends on the place on it. */
static bool gravity_acts(const struct talus_scene *scene, size_t axis)
{
    bool acts = scene->gravity[axis] != 0.0 || scene->gravity_table[axis].count > 0;
    for (size_t index = 0; index < scene->slope_count; index++)
        acts |= scene->slopes[index].along[axis] != 0.0 || isnan(scene->slopes[index].below);
    return acts;
}

/* Range of all bodies on an axis; true if every body is a box over all of it. */
static bool bodies_fill(const struct talus_scene *scene, size_t axis, double range[2])
{
    for (size_t index = 0; index < scene->body_count; index++) {
        struct seeding_shape shape;
        seeding_shape_init(&shape, scene, &scene->bodies[index]);
        if (index == 0) {
            range[0] = shape.min[axis];
            range[1] = shape.max[axis];
        }
        if (scene->bodies[index].shape != TALUS_BODY_BOX || shape.turned ||
            scene->bodies[index].traction_count > 0 ||
            scene->bodies[index].velocity_field != TALUS_VELOCITY_UNIFORM ||
            scene->bodies[index].velocity[axis] != 0.0 ||
            !near_scaled(scene, axis, shape.min[axis], range[0]) ||
            !near_scaled(scene, axis, shape.max[axis], range[1]))
            return false;
    }
    return true;
}

/* True if the boundary looks the same at every place of the range on the axis. */
static bool boundary_is_uniform(const struct talus_boundary *boundary, size_t axis,
                                const double range[2])
{
    double along = fabs(boundary->normal[axis]);
    if (boundary->velocity[axis] != 0.0 || boundary->velocity_tables[axis].count > 0)
        return false;
    if (boundary->shape == TALUS_BOUNDARY_BOX)
        return boundary->box_min[axis] <= range[0] && boundary->box_max[axis] >= range[1];
    if (along > 1.0 - 1e-9) /* a side wall: only without friction */
        return strcmp(scene_condition_name(boundary->faces[0].condition_index), "slip") == 0;
    if (along > 1e-9)
        return false;
    if (boundary->shape == TALUS_BOUNDARY_PLANE)
        return true;
    double half = 0.5 * (fabs(boundary->axis_1[axis]) * boundary->size[0] +
                         fabs(boundary->axis_2[axis]) * boundary->size[1]);
    return boundary->point[axis] - half <= range[0] && boundary->point[axis] + half >= range[1];
}

void scene_advise_uniform(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    for (size_t axis = 0; axis < 3 && scene->dimension == TALUS_SOLID; axis++) {
        double range[2] = {0.0, 0.0};
        bool uniform = !gravity_acts(scene, axis) && bodies_fill(scene, axis, range);
        for (size_t index = 0; index < scene->boundary_count && uniform; index++)
            uniform = boundary_is_uniform(&scene->boundaries[index], axis, range);
        /* Free ends move: only between walls is nothing happening along the axis. */
        size_t walls = 0;
        for (size_t index = 0; index < scene->boundary_count && uniform; index++) {
            const struct talus_boundary *boundary = &scene->boundaries[index];
            walls += boundary->shape == TALUS_BOUNDARY_PLANE &&
                     fabs(boundary->normal[axis]) > 1.0 - 1e-9;
        }
        if (!uniform || walls < 2)
            continue;
        char detail[96], saves[96];
        double cells = (range[1] - range[0]) / scene->grid.cell[axis];
        (void)snprintf(detail, sizeof detail, "nothing in this scene changes along %c",
                       "xyz"[axis]);
        (void)snprintf(saves, sizeof saves, "a factor of about %.0f in particles and wall time",
                       fmax(2.0, cells * 1.5));
        scene_advise(advice, "/dimension", "uniform_axis", detail,
                     "\"dimension\": \"plane_strain\", without that axis", saves);
        return;
    }
}

static double mirrored(double place, double centre)
{
    return 2.0 * centre - place;
}

/* True if body b is the mirror image of body a. */
static bool bodies_mirror(const struct talus_scene *scene, size_t axis, double centre,
                          const struct talus_body *a, const struct talus_body *b)
{
    struct seeding_shape first, second;
    seeding_shape_init(&first, scene, a);
    seeding_shape_init(&second, scene, b);
    bool same = a->shape == b->shape && a->material_index == b->material_index &&
                a->radius == b->radius && a->initial_stress == b->initial_stress &&
                (a->shape == TALUS_BODY_BOX || a->shape == TALUS_BODY_SPHERE) && !first.turned &&
                !second.turned && a->traction_count == 0 && b->traction_count == 0 &&
                a->velocity_field == TALUS_VELOCITY_UNIFORM &&
                b->velocity_field == TALUS_VELOCITY_UNIFORM;
    for (size_t k = 0; k < scene->axis_count; k++) {
        double low = k == axis ? mirrored(second.max[k], centre) : second.min[k];
        double high = k == axis ? mirrored(second.min[k], centre) : second.max[k];
        double velocity = k == axis ? -b->velocity[k] : b->velocity[k];
        same = same && near_scaled(scene, k, first.min[k], low) &&
               near_scaled(scene, k, first.max[k], high) &&
               near(a->velocity[k], velocity, fabs(velocity));
    }
    return same && (axis != 0 || a->stress[3] == 0.0);
}

static bool boundaries_mirror(const struct talus_scene *scene, size_t axis, double centre,
                              const struct talus_boundary *a, const struct talus_boundary *b)
{
    bool same = a->shape == b->shape && a->wall == b->wall &&
                a->tension_release == b->tension_release && a->shape != TALUS_BOUNDARY_FACE &&
                a->prescribed == 0 && b->prescribed == 0 && a->timed == b->timed &&
                a->from == b->from && a->until == b->until;
    for (size_t face = 0; face < a->face_count && same; face++) {
        size_t other = a->shape == TALUS_BOUNDARY_BOX && face / 2 == axis ? face ^ 1u : face;
        same = a->faces[face].condition_index == b->faces[other].condition_index &&
               a->faces[face].friction_coefficient == b->faces[other].friction_coefficient &&
               a->faces[face].adhesion == b->faces[other].adhesion &&
               a->faces[face].turbulence == b->faces[other].turbulence;
    }
    if (a->shape == TALUS_BOUNDARY_BOX) {
        for (size_t k = 0; k < scene->axis_count && same; k++) {
            double low = k == axis ? mirrored(b->box_max[k], centre) : b->box_min[k];
            double high = k == axis ? mirrored(b->box_min[k], centre) : b->box_max[k];
            same = near_scaled(scene, k, a->box_min[k], low) &&
                   near_scaled(scene, k, a->box_max[k], high);
        }
        return same;
    }
    double offset = 0.0, smallest = scene->grid.cell[axis];
    for (size_t k = 0; k < scene->axis_count && same; k++) {
        double normal = k == axis ? -b->normal[k] : b->normal[k];
        double point = k == axis ? mirrored(b->point[k], centre) : b->point[k];
        same = near(a->normal[k], normal, 1.0);
        offset += a->normal[k] * (point - a->point[k]);
    }
    return same && fabs(offset) <= 1e-9 * smallest;
}

/* Every entry has its image among the entries. */
static bool is_mirror(const struct talus_scene *scene, size_t axis, double centre)
{
    for (size_t index = 0; index < scene->body_count; index++) {
        bool found = false;
        for (size_t other = 0; other < scene->body_count && !found; other++)
            found =
                bodies_mirror(scene, axis, centre, &scene->bodies[index], &scene->bodies[other]);
        if (!found)
            return false;
    }
    for (size_t index = 0; index < scene->boundary_count; index++) {
        bool found = false;
        for (size_t other = 0; other < scene->boundary_count && !found; other++)
            found = boundaries_mirror(scene, axis, centre, &scene->boundaries[index],
                                      &scene->boundaries[other]);
        if (!found)
            return false;
    }
    return true;
}

void scene_advise_mirror(struct scene_advice *advice)
{
    enum { ENTRY_MAX = 64 }; /* pairs are compared: larger scenes are left alone */
    const struct talus_scene *scene = advice->scene;
    if (scene->body_count > ENTRY_MAX || scene->boundary_count > ENTRY_MAX || scene->axis_count < 2)
        return;
    for (size_t axis = 0; axis < scene->axis_count; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t index = 0; index < scene->body_count; index++) {
            struct seeding_shape shape;
            seeding_shape_init(&shape, scene, &scene->bodies[index]);
            low = fmin(low, shape.min[axis]);
            high = fmax(high, shape.max[axis]);
        }
        double centre = 0.5 * (low + high);
        /* Across the radius of a body of revolution nothing mirrors. */
        if (axis == 0 && scene->dimension == TALUS_AXISYMMETRIC)
            continue;
        if (gravity_acts(scene, axis) || !is_mirror(scene, axis, centre))
            continue;
        char detail[128], change[128];
        (void)snprintf(detail, sizeof detail, "the scene is its own mirror image about %c = %g",
                       "xyz"[axis], centre);
        (void)snprintf(change, sizeof change,
                       "model one half, with a slip plane through %c = %g (moments and forces of "
                       "one half double)",
                       "xyz"[axis], centre);
        scene_advise(advice, "/grid", "mirror_symmetry", detail, change,
                     "half of the particles and of the wall time");
        return;
    }
}

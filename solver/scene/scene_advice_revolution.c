/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes in 3D whose bodies are balls and cylinders about one line along the grid. */
#include "scene/scene_advice.h"
#include "scene/scene_condition.h"

#include "seeding/seeding_shape.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool near(double a, double b, double scale)
{
    return fabs(a - b) <= 1e-9 * scale;
}

/* True if the body is one of revolution about the line through `centre` along the axis, and moves
 * along it only; the first body says where the line is. */
static bool body_revolves(const struct talus_scene *scene, const struct talus_body *body,
                          size_t axis, bool first, double centre[3])
{
    struct seeding_shape shape;
    seeding_shape_init(&shape, scene, body);
    const bool cylinder = body->shape == TALUS_BODY_CYLINDER;
    if ((!cylinder && body->shape != TALUS_BODY_SPHERE) || shape.turned || shape.clipped ||
        body->velocity_field != TALUS_VELOCITY_UNIFORM || body->traction_count > 0 ||
        body->initial_stress == TALUS_INITIAL_GIVEN)
        return false;
    const double *place = cylinder ? body->from : body->centre;
    for (size_t k = 0; k < 3; k++) {
        if (k == axis)
            continue;
        if (first)
            centre[k] = place[k];
        if (!near(place[k], centre[k], scene->grid.cell[k]) || body->velocity[k] != 0.0 ||
            (cylinder && !near(body->to[k], place[k], scene->grid.cell[k])))
            return false;
    }
    return true;
}

/* Planes across the line that do not move along themselves. */
static bool boundary_revolves(const struct talus_boundary *boundary, size_t axis)
{
    bool still =
        boundary->shape == TALUS_BOUNDARY_PLANE && fabs(boundary->normal[axis]) > 1.0 - 1e-9;
    for (size_t k = 0; k < 3; k++)
        still = still && (k == axis || (boundary->velocity[k] == 0.0 &&
                                        boundary->velocity_tables[k].count == 0));
    return still;
}

static bool scene_revolves(const struct talus_scene *scene, size_t axis)
{
    double centre[3] = {0.0, 0.0, 0.0};
    bool revolves = scene->slope_count == 0 && scene->body_count > 0;
    for (size_t k = 0; k < 3; k++)
        revolves = revolves &&
                   (k == axis || (scene->gravity[k] == 0.0 && scene->gravity_table[k].count == 0));
    for (size_t index = 0; index < scene->body_count && revolves; index++)
        revolves = body_revolves(scene, &scene->bodies[index], axis, index == 0, centre);
    for (size_t index = 0; index < scene->boundary_count && revolves; index++)
        revolves = boundary_revolves(&scene->boundaries[index], axis);
    return revolves;
}

/* Cells along the largest radius. */
static double cells_of_radius(const struct talus_scene *scene, size_t axis)
{
    double radius = 0.0;
    for (size_t index = 0; index < scene->body_count; index++)
        radius = fmax(radius, scene->bodies[index].radius);
    return radius / scene->grid.cell[(axis + 1) % 3];
}

void scene_advise_revolution(struct scene_advice *advice)
{
    const struct talus_scene *scene = advice->scene;
    for (size_t axis = 0; axis < 3 && scene->dimension == TALUS_SOLID; axis++) {
        if (!scene_revolves(scene, axis))
            continue;
        char detail[128], saves[96];
        (void)snprintf(detail, sizeof detail,
                       "everything in this scene is a body of revolution about a line along %c",
                       "xyz"[axis]);
        /* pi r^2 against r, two particles a cell and axis. */
        (void)snprintf(saves, sizeof saves, "a factor of about %.0f in particles and wall time",
                       fmax(2.0, 6.3 * cells_of_radius(scene, axis)));
        scene_advise(advice, "/dimension", "body_of_revolution", detail,
                     "\"dimension\": \"axisymmetric\", with the distance from that line as x and "
                     "the way along it as y",
                     saves);
        return;
    }
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes that equal their mirror image: one half of them is enough. */
#include "scene/scene_advice.h"
#include "scene/scene_mirror.h"

#include <math.h>
#include <stdio.h>

static bool gravity_mirrors(const struct talus_scene *scene, size_t axis)
{
    bool mirrors = scene->gravity[axis] == 0.0 && scene->gravity_table[axis].count == 0;
    for (size_t index = 0; index < scene->slope_count; index++)
        mirrors = mirrors && scene->slopes[index].along[axis] == 0.0 &&
                  !isnan(scene->slopes[index].below);
    return mirrors;
}

/* Where the grid takes material out, its two ends count too. */
static bool grid_mirrors(const struct scene_mirror *mirror)
{
    const struct talus_grid *grid = &mirror->scene->grid;
    const size_t axis = mirror->axis;
    const double end = grid->min[axis] + grid->cell[axis] * (double)grid->cell_count[axis];
    return grid->outside != TALUS_OUTSIDE_ELIMINATE ||
           scene_mirror_near(mirror, axis, grid->min[axis], end);
}

/* Every entry has its image among the entries. */
static bool scene_mirrors(struct scene_mirror *mirror)
{
    const struct talus_scene *scene = mirror->scene;
    for (size_t index = 0; index < scene->body_count; index++) {
        bool found = false;
        for (size_t other = 0; other < scene->body_count && !found; other++)
            found = scene_mirror_bodies(mirror, &scene->bodies[index], &scene->bodies[other]);
        if (!found)
            return false;
    }
    for (size_t index = 0; index < scene->boundary_count; index++) {
        bool found = false;
        for (size_t other = 0; other < scene->boundary_count && !found; other++)
            found = scene_mirror_boundaries(mirror, &scene->boundaries[index],
                                            &scene->boundaries[other]);
        if (!found)
            return false;
    }
    return grid_mirrors(mirror);
}

static double middle_of(const struct talus_scene *scene, size_t axis)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t index = 0; index < scene->body_count; index++) {
        double min[3], max[3];
        scene_body_bounds(scene, &scene->bodies[index], min, max);
        low = fmin(low, min[axis]);
        high = fmax(high, max[axis]);
    }
    return 0.5 * (low + high);
}

static void advise_half(struct scene_advice *advice, const struct scene_mirror *mirror)
{
    const struct talus_grid *grid = &advice->scene->grid;
    const double lines = (mirror->centre - grid->min[mirror->axis]) / grid->cell[mirror->axis];
    const bool on_line = fabs(lines - round(lines)) < 1e-6;
    char detail[128], change[192];
    (void)snprintf(detail, sizeof detail, "the scene is its own mirror image about %c = %g",
                   "xyz"[mirror->axis], mirror -> centre);
    (void)snprintf(change, sizeof change,
                   "model one half, with a slip plane through %c = %g%s (extensive results of the "
                   "half double)",
                   "xyz"[mirror->axis], mirror -> centre,
                   on_line ? "" : " and the grid moved so that the plane is a grid line");
    scene_advise(advice, &(struct scene_advice_item){
                             .pointer = "/grid",
                             .code = "mirror_symmetry",
                             .detail = detail,
                             .change = change,
                             .saves = "half of the particles and of the wall time",
                             .quantity = "particle_steps",
                             .factor = 2.0,
                         });
}

void scene_advise_mirror(struct scene_advice *advice)
{
    enum { ENTRY_MAX = 64 }; /* pairs are compared: larger scenes are left alone */
    const struct talus_scene *scene = advice->scene;
    if (scene->body_count > ENTRY_MAX || scene->boundary_count > ENTRY_MAX || scene->axis_count < 2)
        return;
    for (size_t axis = 0; axis < scene->axis_count; axis++) {
        /* Across the radius of a body of revolution nothing mirrors. */
        if ((axis == 0 && scene->dimension == TALUS_AXISYMMETRIC) ||
            (advice->settled_axes >> axis & 1u) != 0 || !gravity_mirrors(scene, axis))
            continue;
        struct scene_mirror mirror = {
            .scene = scene, .axis = axis, .centre = middle_of(scene, axis)};
        if (!scene_mirrors(&mirror))
            continue;
        advise_half(advice, &mirror);
        return;
    }
}

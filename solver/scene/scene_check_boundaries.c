/* SPDX-License-Identifier: Apache-2.0 */
/* Boundaries act at nodes: says where, if that is not where they were put. */
#include "scene/scene_condition.h"
#include "scene/scene_sections.h"

#include <stdio.h>

/* Share of a cell within which something counts as lying on a grid line. */
static const double line_tolerance = 0.01;

/* The nearest grid line; true if `place` is off it. */
static bool is_off_line(const struct talus_grid *grid, size_t axis, double place, double *line)
{
    double lines = (place - grid->min[axis]) / grid->cell[axis];
    *line = grid->min[axis] + round(lines) * grid->cell[axis];
    return fabs(lines - round(lines)) > line_tolerance;
}

static void check_flat(struct scene_reader *reader, const struct scene_path *path,
                       const struct talus_boundary *boundary)
{
    const struct talus_grid *grid = &reader->scene->grid;
    for (size_t k = 0; k < reader->axis_count; k++) {
        double line;
        if (fabs(boundary->normal[k]) < 1.0 - 1e-9)
            continue;
        if (is_off_line(grid, k, boundary->point[k], &line))
            scene_warn(reader, path, "off_grid_line",
                       "'%s' is at %c = %g, between grid lines: it acts on the nodes at %c = %g",
                       boundary->name, "xyz"[k], boundary -> point[k], "xyz"[k], line);
        return;
    }
    scene_warn(reader, path, "oblique",
               "'%s' is not parallel to grid lines: it acts on the nodes within half a cell of it, "
               "a staircase",
               boundary->name);
}

static void check_box(struct scene_reader *reader, const struct scene_path *path,
                      const struct talus_boundary *boundary)
{
    const struct talus_grid *grid = &reader->scene->grid;
    for (size_t k = 0; k < reader->axis_count; k++) {
        double low, high;
        bool low_off = is_off_line(grid, k, boundary->box_min[k], &low);
        bool high_off = is_off_line(grid, k, boundary->box_max[k], &high);
        double end = grid->min[k] + (double)grid->cell_count[k] * grid->cell[k];
        if (boundary->box_max[k] < grid->min[k] || boundary->box_min[k] > end) {
            scene_warn(reader, path, "outside_grid", "'%s' lies outside of the grid",
                       boundary->name);
            return;
        }
        if (low == high)
            scene_warn(reader, path, "thin",
                       "'%s' is thinner than half a cell along %c: it acts on one layer of nodes",
                       boundary->name, "xyz"[k]);
        else if (low_off || high_off)
            scene_warn(reader, path, "off_grid_line",
                       "'%s' from %c = %g to %g is not on grid lines: it acts on the nodes from %g "
                       "to %g",
                       boundary->name, "xyz"[k], boundary -> box_min[k], boundary -> box_max[k],
                       low, high);
    }
}

void scene_check_boundaries(struct scene_reader *reader)
{
    static const char *const keys[] = {
        [TALUS_BOUNDARY_PLANE] = "plane",
        [TALUS_BOUNDARY_FACE] = "face",
        [TALUS_BOUNDARY_BOX] = "box",
    };
    struct scene_path boundaries = {.key = "boundaries"};
    for (size_t index = 0; index < reader->scene->boundary_count; index++) {
        const struct talus_boundary *boundary = &reader->scene->boundaries[index];
        struct scene_path entry = {.parent = &boundaries, .index = index};
        struct scene_path here = {.parent = &entry, .key = keys[boundary->shape]};
        if (scene_condition_eliminates(boundary->faces[0].condition_index))
            continue; /* takes particles out wherever it is */
        if (boundary->shape == TALUS_BOUNDARY_BOX)
            check_box(reader, &here, boundary);
        else
            check_flat(reader, &here, boundary);
    }
}

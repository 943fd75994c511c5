/* SPDX-License-Identifier: Apache-2.0 */
/* The grid: cells and the box that bounds the problem. */
#include "scene/scene_sections.h"

#include <string.h>

static const char *const outside_words[] = {"error", "eliminate", NULL};

struct grid_keys {
    double cell[3], min[3], max[3];
    enum talus_outside outside;
    double outside_mass_limit;
};

const struct scene_field scene_grid_fields[] = {
    {.key = "cell",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .maximum = INFINITY,
     .above_minimum = true,
     .required = true,
     .default_value = NAN,
     .scalar = true,
     .offset = offsetof(struct grid_keys, cell),
     .meaning = "size of a cell: one number, or one per axis"},
    {.key = "min",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = offsetof(struct grid_keys, min),
     .meaning = "lower corner of the box that bounds the problem"},
    {.key = "max",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = offsetof(struct grid_keys, max),
     .meaning = "upper corner, rounded up to whole cells"},
    {.key = "outside",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = outside_words,
     .offset = offsetof(struct grid_keys, outside),
     .meaning =
         "what happens to a particle that leaves the grid: the run ends, or it is taken out"},
    {.key = "outside_mass_limit",
     .kind = SCENE_NUMBER,
     .unit = "1",
     .minimum = 0.0,
     .maximum = 1.0,
     .default_value = 0.001,
     .offset = offsetof(struct grid_keys, outside_mass_limit),
     .meaning = "share of the initial mass that may be taken out before the run ends"},
    {.key = NULL},
};

/* Whole cells between min and max on one axis; 0 with a mistake. */
static int64_t count_cells(struct scene_reader *reader, const struct scene_path *path,
                           const struct grid_keys *keys, size_t axis)
{
    struct scene_path max = {.parent = path, .key = "max"};
    struct scene_path here = {.parent = &max, .index = axis};
    double cells = (keys->max[axis] - keys->min[axis]) / keys->cell[axis];
    if (!(cells > 0.0)) {
        scene_mistake(reader, &here, "order", NULL, NULL, "max %g must be above min %g",
                      keys->max[axis], keys->min[axis]);
        return 0;
    }
    if (!(cells <= SCENE_CELL_MAX)) {
        scene_mistake(reader, &here, "limit", NULL, NULL,
                      "%.3g cells on this axis; at most %d are allowed", cells, SCENE_CELL_MAX);
        return 0;
    }
    return (int64_t)fmax(1.0, ceil(cells - 1e-6)); /* 0.15 / 0.005 is not quite 30 */
}

static void fill_grid(struct scene_reader *reader, const struct scene_path *path,
                      struct grid_keys *keys, json_t *effective)
{
    struct talus_grid *grid = &reader->scene->grid;
    json_t *max = json_array();
    for (size_t k = 0; k < reader->axis_count; k++) {
        grid->cell_count[k] = count_cells(reader, path, keys, k);
        grid->cell[k] = keys->cell[k];
        grid->min[k] = keys->min[k];
        double rounded = keys->min[k] + (double)grid->cell_count[k] * keys->cell[k];
        bool whole = fabs(rounded - keys->max[k]) <= 1e-6 * keys->cell[k];
        if (json_array_append_new(max, json_real(whole ? keys->max[k] : rounded)) != 0)
            reader->out_of_memory = true;
    }
    scene_put(reader, effective, "max", max);
}

void scene_grid_read(struct scene_reader *reader, const struct scene_path *path,
                     const json_t *given, void *target, json_t *effective)
{
    struct talus_grid *grid = &((struct talus_scene *)target)->grid;
    struct grid_keys keys;
    memset(&keys, 0, sizeof keys);
    for (size_t k = 0; k < 3; k++) {
        grid->cell[k] = 1.0;
        grid->cell_count[k] = 1;
        keys.cell[k] = keys.min[k] = keys.max[k] = NAN;
    }
    json_t *inner = json_object();
    scene_fields_read(reader, path, scene_grid_fields, given, &keys, inner);
    bool complete = reader->axis_count > 0;
    for (size_t k = 0; k < reader->axis_count; k++)
        complete &= !isnan(keys.cell[k]) && !isnan(keys.min[k]) && !isnan(keys.max[k]);
    if (complete)
        fill_grid(reader, path, &keys, inner);
    grid->outside = keys.outside;
    grid->outside_mass_limit = keys.outside_mass_limit;
    scene_put(reader, effective, path->key, inner);
}

json_t *scene_grid_schema(void)
{
    return scene_fields_schema(scene_grid_fields);
}

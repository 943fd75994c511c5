/* SPDX-License-Identifier: Apache-2.0 */
/* Gravity: a vector, whose components may be tables over time; or a magnitude that is tilted by
 * slopes. */
#include "scene/scene_face.h"
#include "scene/scene_sections.h"
#include "scene/scene_time_table.h"

#include <stddef.h>
#include <stdlib.h>

static const struct scene_field vector_field = {
    .key = "gravity",
    .kind = SCENE_VECTOR,
    .unit = "m/s^2",
    .minimum = -1e6,
    .maximum = 1e6,
    .meaning = "acceleration",
};

#define AT(member) offsetof(struct talus_slope, member)

static const struct scene_field slope_fields[] = {
    {.key = "along",
     .kind = SCENE_VECTOR,
     .unit = "1",
     .required = true,
     .default_value = NAN,
     .offset = AT(along),
     .meaning = "downhill, perpendicular to up; any length"},
    {.key = "below",
     .kind = SCENE_NUMBER,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .alternative = "zone",
     .offset = AT(below),
     .meaning = "holds where the position along `along` is below"},
    {.key = "beyond",
     .kind = SCENE_NUMBER,
     .unit = "m",
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .alternative = "zone",
     .needs = "about",
     .offset = AT(beyond),
     .meaning = "holds beyond this distance from `about`, perpendicular to up"},
    {.key = "about",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .default_value = NAN,
     .needs = "beyond",
     .offset = AT(about),
     .meaning = "centre, with beyond"},
    {.key = "angle",
     .kind = SCENE_NUMBER,
     .unit = "deg",
     .minimum = -90.0,
     .maximum = 90.0,
     .required = true,
     .default_value = NAN,
     .offset = AT(angle_deg),
     .meaning = "by which gravity is tilted towards `along`"},
    {.key = NULL},
};

static void read_slope(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *item, json_t *effective)
{
    struct talus_slope *slope = item;
    struct scene_path along = {.parent = path, .key = "along"};
    for (size_t k = 0; k < reader->axis_count; k++)
        slope->along[k] = NAN;
    scene_fields_read(reader, path, slope_fields, given, slope, effective);
    if (!isnan(slope->along[0]))
        (void)scene_direction_normalise(reader, &along, slope->along, effective);
    const double *up = reader->scene->gravity;
    double scale = 0.0, lean = 0.0;
    for (size_t k = 0; k < 3; k++) {
        lean += slope->along[k] * up[k];
        scale += fabs(up[k]);
    }
    if (fabs(lean) > 1e-9 * scale) /* false for what was not readable (NAN) */
        scene_mistake(reader, &along, "contradiction", NULL, NULL,
                      "'along' must be perpendicular to 'up'");
}

static void read_slopes(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = reader->scene;
    void *items;
    (void)target;
    scene->slope_count = scene_list_read(reader, path, given, 0, sizeof(struct talus_slope), &items,
                                         effective, read_slope);
    scene->slopes = items;
}

static json_t *slopes_schema(void)
{
    return scene_list_schema(slope_fields, 0);
}

struct tilted {
    double magnitude, up[3];
};

static const struct scene_field up_field = {.key = "up", .unit = "1"};

static void read_up(struct scene_reader *reader, const struct scene_path *path, const json_t *given,
                    void *target, json_t *effective)
{
    struct tilted *tilted = target;
    json_t *value = NULL;
    if (!scene_vector_read(reader, path, &up_field, given, tilted->up, &value))
        return;
    scene_put(reader, effective, path->key, value);
    if (!scene_direction_normalise(reader, path, tilted->up, effective))
        return;
    for (size_t k = 0; k < reader->axis_count; k++)
        reader->scene->gravity[k] = tilted->up[k] == 0.0 ? 0.0 : -tilted->magnitude * tilted->up[k];
}

static json_t *up_schema(void)
{
    return scene_axes_schema(scene_number_schema(&up_field), 0);
}

/* In this order: slopes are compared with gravity where none holds. */
static const struct scene_field tilted_fields[] = {
    {.key = "magnitude",
     .kind = SCENE_NUMBER,
     .unit = "m/s^2",
     .maximum = 1e6,
     .required = true,
     .default_value = NAN,
     .offset = offsetof(struct tilted, magnitude),
     .meaning = "magnitude everywhere"},
    {.key = "up",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .read = read_up,
     .schema = up_schema,
     .meaning = "against gravity where no slope holds; any length"},
    {.key = "slopes",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .read = read_slopes,
     .schema = slopes_schema,
     .meaning = "tilts; the first that holds counts, else gravity is straight down"},
    {.key = NULL},
};

void scene_gravity_read(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = target;
    struct tilted tilted = {.magnitude = NAN};
    json_t *value = NULL;
    if (json_is_object(given)) {
        value = json_object();
        scene_fields_read(reader, path, tilted_fields, given, &tilted, value);
    } else if (given == NULL) {
        value = scene_zero_vector(reader);
    } else if (!scene_timed_vector_read(reader, path, &vector_field, given, scene->gravity,
                                        scene->gravity_table, &value)) {
        return;
    }
    scene_put(reader, effective, path->key, value);
}

json_t *scene_gravity_schema(void)
{
    return json_pack("{s:[o, o]}", "oneOf", scene_timed_vector_schema(&vector_field),
                     scene_fields_schema(tilted_fields));
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Bodies: shape, lattice, material, initial velocity. */
#include "scene/scene_body.h"
#include "scene/scene_sections.h"

#include <string.h>

/* What an entry says, before names are resolved. */
struct body_keys {
    struct talus_body body;
    const char *name;
};
#define AT(member) offsetof(struct body_keys, body.member)

#define VECTOR(NAME, MEMBER, MEANING)                                                              \
    {                                                                                              \
        .key = NAME, .kind = SCENE_VECTOR, .unit = "m", .required = true, .default_value = NAN,    \
        .offset = AT(MEMBER), .meaning = MEANING                                                   \
    }
#define OPEN_VECTOR(NAME, MEMBER, DEFAULT, MEANING)                                                \
    {                                                                                              \
        .key = NAME, .kind = SCENE_VECTOR, .unit = "m", .default_value = DEFAULT, .open = true,    \
        .offset = AT(MEMBER), .meaning = MEANING                                                   \
    }
#define RADIUS                                                                                     \
    {                                                                                              \
        .key = "radius", .kind = SCENE_NUMBER, .unit = "m", .maximum = INFINITY,                   \
        .above_minimum = true, .required = true, .default_value = NAN, .offset = AT(radius),       \
        .meaning = "radius"                                                                        \
    }

static const struct scene_field box_fields[] = {
    VECTOR("min", box_min, "lower corner"),
    VECTOR("max", box_max, "upper corner"),
    {.key = NULL},
};
static const struct scene_field sphere_fields[] = {
    VECTOR("centre", centre, "centre"),
    RADIUS,
    {.key = NULL},
};
static const struct scene_field cylinder_fields[] = {
    VECTOR("from", from, "centre of one end"),
    VECTOR("to", to, "centre of the other end"),
    RADIUS,
    {.key = NULL},
};
static const struct scene_field clip_fields[] = {
    OPEN_VECTOR("min", clip_min, -INFINITY, "lower corner; null: open"),
    OPEN_VECTOR("max", clip_max, INFINITY, "upper corner; null: open"),
    {.key = NULL},
};

#define SHAPE(NAME, FIELDS, MEANING)                                                               \
    {                                                                                              \
        .key = NAME, .kind = SCENE_OBJECT, .unit = "1", .required = true, .alternative = "shape",  \
        .fields = FIELDS, .meaning = MEANING                                                       \
    }
#define LATTICE(NAME, UNIT, MINIMUM, ABOVE, WHOLE, MEANING)                                        \
    {                                                                                              \
        .key = NAME, .kind = SCENE_VECTOR, .unit = UNIT, .minimum = MINIMUM, .maximum = 1e9,       \
        .above_minimum = ABOVE, .required = true, .default_value = NAN, .alternative = "lattice",  \
        .whole = WHOLE, .scalar = true, .offset = AT(lattice_value), .meaning = MEANING            \
    }

static void read_material(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *target, json_t *effective)
{
    int index = scene_material_find(reader, path, given);
    if (index < 0)
        return;
    ((struct body_keys *)target)->body.material_index = (size_t)index;
    scene_put(reader, effective, path->key, json_string(json_string_value(given)));
}

static json_t *name_schema(void)
{
    return json_pack("{s:s}", "type", "string");
}

const struct scene_field scene_body_fields[] = {
    {.key = "name",
     .kind = SCENE_NAME,
     .unit = "1",
     .offset = offsetof(struct body_keys, name),
     .meaning = "name in probes, filters and messages; default body_INDEX"},
    {.key = "material",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .read = read_material,
     .schema = name_schema,
     .meaning = "name of its material"},
    SHAPE("box", box_fields, "box with sides along the axes"),
    SHAPE("sphere", sphere_fields, "sphere; a disc in 2D"),
    SHAPE("cylinder", cylinder_fields, "cylinder in 3D"),
    SHAPE("polygon", scene_polygon_fields, "polygon in 2D, convex or not"),
    {.key = "points",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .required = true,
     .alternative = "shape",
     .also = "lattice",
     .fields = scene_points_fields,
     .meaning = "the particles themselves; they have no lattice"},
    {.key = "clip",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .fields = clip_fields,
     .meaning = "box that cuts the shape"},
    {.key = "rotate",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = scene_body_rotate_read,
     .schema = scene_body_rotate_schema,
     .meaning = "turns shape, clip and lattice as a whole"},
    LATTICE("particles_per_cell", "1", 0.0, true, false, "particles per cell along each axis"),
    LATTICE("spacing", "m", 0.0, true, false, "distance of particles along each axis"),
    LATTICE("count", "1", 1.0, false, true, "particles along each axis of the bounding box"),
    {.key = "velocity",
     .kind = SCENE_CUSTOM,
     .unit = "m/s",
     .read = scene_body_velocity_read,
     .schema = scene_body_velocity_schema,
     .meaning = "velocity at the start: a vector, {\"rotation\": {...}} or {\"beam_mode\": {...}}"},
    {.key = "initial_stress",
     .kind = SCENE_CUSTOM,
     .unit = "Pa",
     .read = scene_initial_stress_read,
     .schema = scene_initial_stress_schema,
     .meaning = "stress at the start"},
    {.key = "traction",
     .kind = SCENE_CUSTOM,
     .unit = "Pa",
     .read = scene_body_traction_read,
     .schema = scene_body_traction_schema,
     .meaning = "loads on faces"},
    {.key = "phase", .unsupported = true},
    {.key = NULL},
};

static void check_order(struct scene_reader *reader, const struct scene_path *path, const char *key,
                        const double min[3], const double max[3])
{
    for (size_t k = 0; k < reader->axis_count; k++) {
        struct scene_path shape = {.parent = path, .key = key};
        struct scene_path corner = {.parent = &shape, .key = "max"};
        struct scene_path here = {.parent = &corner, .index = k};
        if (max[k] <= min[k]) /* false for what was not readable (NAN) */
            scene_mistake(reader, &here, "order", NULL, NULL, "max %g must be above min %g", max[k],
                          min[k]);
    }
}

static void check_clip(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, const struct talus_body *body)
{
    struct scene_path clip = {.parent = path, .key = "clip"};
    bool clipped = false;
    for (size_t k = 0; k < reader->axis_count; k++)
        clipped |= body->clip_min[k] > -INFINITY || body->clip_max[k] < INFINITY;
    if (json_object_get(given, "points") != NULL && clipped)
        scene_mistake(reader, &clip, "contradiction", NULL, NULL,
                      "a list of points is not clipped: leave points out instead");
}

static void check_shape(struct scene_reader *reader, const struct scene_path *path,
                        const struct talus_body *body)
{
    struct scene_path here = {.parent = path, .key = "cylinder"};
    if (body->shape == TALUS_BODY_BOX)
        check_order(reader, path, "box", body->box_min, body->box_max);
    check_order(reader, path, "clip", body->clip_min, body->clip_max);
    if (body->shape != TALUS_BODY_CYLINDER)
        return;
    struct scene_path end = {.parent = &here, .key = "to"};
    if (reader->axis_count != 3 && reader->axis_count != 0)
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "a cylinder needs the dimension \"solid\"");
    else if (body->from[0] == body->to[0] && body->from[1] == body->to[1] &&
             body->from[2] == body->to[2])
        scene_mistake(reader, &end, "direction", NULL, NULL, "'from' and 'to' are the same point");
}

static void read_body(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *item, json_t *effective)
{
    struct body_keys keys;
    memset(&keys, 0, sizeof keys);
    struct talus_body *body = &keys.body;
    for (size_t k = 0; k < 3; k++) {
        body->box_min[k] = body->box_max[k] = k < reader->axis_count ? NAN : 0.0;
        body->clip_min[k] = -INFINITY;
        body->clip_max[k] = INFINITY;
        body->from[k] = body->to[k] = body->box_min[k];
        body->lattice_value[k] = 1.0;
    }
    body->surface = NAN;
    static const char *const shapes[] = {"box", "sphere", "cylinder", "polygon", "points"};
    for (int shape = 0; shape <= (int)TALUS_BODY_POINTS; shape++) {
        if (json_object_get(given, shapes[shape]) != NULL)
            body->shape = (enum talus_body_shape)shape;
    }
    scene_fields_read(reader, path, scene_body_fields, given, &keys, effective);
    if (json_object_get(given, "spacing") != NULL)
        body->lattice = TALUS_LATTICE_SPACING;
    else if (json_object_get(given, "count") != NULL)
        body->lattice = TALUS_LATTICE_COUNT;
    check_clip(reader, path, given, body);
    check_shape(reader, path, body);
    body->name = scene_entry_name(reader, path, keys.name, "body", effective);
    memcpy(item, body, sizeof *body);
}

void scene_bodies_read(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = target;
    void *items;
    const char *names[SCENE_ENTRY_MAX];
    scene->body_count = scene_list_read(reader, path, given, 1, sizeof(struct talus_body), &items,
                                        effective, read_body);
    scene->bodies = items;
    for (size_t index = 0; index < scene->body_count; index++)
        names[index] = scene->bodies[index].name;
    scene_names_check(reader, path, names, scene->body_count);
}

json_t *scene_bodies_schema(void)
{
    return scene_list_schema(scene_body_fields, 1);
}

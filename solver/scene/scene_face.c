/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_face.h"

#include <string.h>

struct face_keys {
    double min[3], max[3], point[3], normal[3];
    double size[3]; /* as many as the dimension less one */
};
#define AT(member) offsetof(struct face_keys, member)

static void read_size(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *target, json_t *effective);
static json_t *size_schema(void);

static const struct scene_field face_fields[] = {
    {.key = "min",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .alternative = "place",
     .offset = AT(min),
     .meaning = "lower corner of a face that is flat on an axis"},
    {.key = "point",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .alternative = "place",
     .offset = AT(point),
     .meaning = "centre"},
    {.key = "max",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .default_value = NAN,
     .alternative = "extent",
     .required = true,
     .needs = "min",
     .offset = AT(max),
     .meaning = "upper corner, with min"},
    {.key = "size",
     .kind = SCENE_CUSTOM,
     .unit = "m",
     .required = true,
     .alternative = "extent",
     .needs = "point",
     .read = read_size,
     .schema = size_schema,
     .meaning = "full lengths along t1 and t2, with point"},
    {.key = "normal",
     .kind = SCENE_VECTOR,
     .unit = "1",
     .required = true,
     .default_value = NAN,
     .offset = AT(normal),
     .meaning = "points into the material; any length. t1 is the first of z, x, y (2D: x, y) that "
                "is not parallel to it, made perpendicular; t2 = normal x t1"},
    {.key = NULL},
};

static const struct scene_field size_field = {
    .key = "size", .unit = "m", .above_minimum = true, .maximum = INFINITY};

static void read_size(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *target, json_t *effective)
{
    struct face_keys *keys = target;
    size_t expected = reader->axis_count > 0 ? reader->axis_count - 1 : json_array_size(given);
    if (!json_is_array(given) || json_array_size(given) != expected || expected > 2) {
        scene_mistake(reader, path, "length", given, json_integer((json_int_t)expected),
                      "the size of a face has %zu numbers in this dimension", expected);
        return;
    }
    json_t *list = json_array();
    for (size_t k = 0; k < expected; k++) {
        struct scene_path here = {.parent = path, .index = k};
        if (!scene_number_read(reader, &here, &size_field, json_array_get(given, k),
                               &keys->size[k]))
            keys->size[k] = 1.0;
        if (json_array_append_new(list, json_real(keys->size[k])) != 0)
            reader->out_of_memory = true;
    }
    scene_put(reader, effective, path->key, list);
}

static json_t *size_schema(void)
{
    return scene_axes_schema(scene_number_schema(&size_field), -1);
}

bool scene_direction_normalise(struct scene_reader *reader, const struct scene_path *path,
                               double direction[3], json_t *effective)
{
    double length = hypot(hypot(direction[0], direction[1]), direction[2]);
    if (isnan(length))
        return false;
    if (!(length > 1e-12)) {
        scene_mistake(reader, path, "direction", NULL, NULL, "a direction needs a length");
        return false;
    }
    json_t *list = json_array();
    for (size_t k = 0; k < 3; k++) {
        if (fabs(length - 1.0) > 1e-14) /* a unit vector stays as it is, bit for bit */
            direction[k] /= length;
        if (k < reader->axis_count && json_array_append_new(list, json_real(direction[k])) != 0)
            reader->out_of_memory = true;
    }
    scene_put(reader, effective, path->key, list);
    return true;
}

bool scene_face_normalise(struct scene_reader *reader, const struct scene_path *parent,
                          double normal[3], json_t *effective)
{
    struct scene_path here = {.parent = parent, .key = "normal"};
    return scene_direction_normalise(reader, &here, normal, effective);
}

/* In-plane axes of a face: t1, t2 for a unit normal. In 2D only t1 lies in the plane. */
static void set_axes(struct talus_boundary *boundary, size_t axis_count)
{
    static const size_t orders[2][3] = {{2, 0, 1}, {0, 1, 2}};
    const size_t *order = orders[axis_count == 3 ? 0 : 1];
    const double *n = boundary->normal;
    double *t1 = boundary->axis_1, *t2 = boundary->axis_2;
    for (size_t place = 0; place < 3; place++) {
        size_t k = order[place];
        double norm = sqrt(fmax(0.0, 1.0 - n[k] * n[k]));
        if (norm < 1e-6)
            continue;
        for (size_t j = 0; j < 3; j++)
            t1[j] = ((j == k ? 1.0 : 0.0) - n[k] * n[j]) / norm;
        break;
    }
    for (size_t k = 0; k < 3; k++)
        t2[k] = n[(k + 1) % 3] * t1[(k + 2) % 3] - n[(k + 2) % 3] * t1[(k + 1) % 3];
}

/* {min, max}: the normal must be along the one axis on which they coincide. */
static void from_corners(struct scene_reader *reader, const struct scene_path *path,
                         const struct face_keys *keys, struct talus_boundary *boundary)
{
    struct scene_path normal = {.parent = path, .key = "normal"};
    struct scene_path max = {.parent = path, .key = "max"};
    double extent[3] = {0.0, 0.0, 0.0};
    size_t flat_count = 0;
    bool aligned = true;
    for (size_t k = 0; k < reader->axis_count; k++) {
        struct scene_path here = {.parent = &max, .index = k};
        extent[k] = keys->max[k] - keys->min[k];
        flat_count += extent[k] == 0.0;
        aligned &= (extent[k] == 0.0) == (fabs(boundary->normal[k]) > 1.0 - 1e-12);
        boundary->point[k] = 0.5 * (keys->min[k] + keys->max[k]);
        if (extent[k] < 0.0)
            scene_mistake(reader, &here, "order", NULL, NULL, "max %g must not be below min %g",
                          keys->max[k], keys->min[k]);
    }
    if (flat_count != 1)
        scene_mistake(reader, &max, "contradiction", NULL, NULL,
                      "a face is flat: min and max coincide on exactly one axis");
    else if (!aligned)
        scene_mistake(reader, &normal, "contradiction", NULL, NULL,
                      "the normal must be along the axis on which min and max coincide");
    for (size_t k = 0; k < 3; k++) {
        boundary->size[0] += fabs(boundary->axis_1[k]) * extent[k];
        boundary->size[1] += fabs(boundary->axis_2[k]) * extent[k];
    }
}

void scene_face_read(struct scene_reader *reader, const struct scene_path *path,
                     const json_t *given, struct talus_boundary *boundary, json_t *effective)
{
    struct face_keys keys;
    memset(&keys, 0, sizeof keys);
    for (size_t k = 0; k < reader->axis_count; k++)
        keys.min[k] = keys.max[k] = keys.point[k] = keys.normal[k] = NAN;
    size_t mistakes = reader->issues->count;
    json_t *inner = json_object();
    scene_put(reader, effective, path->key, inner);
    scene_fields_read(reader, path, face_fields, given, &keys, inner);
    if (reader->issues->count != mistakes || reader->axis_count == 0)
        return;
    memcpy(boundary->normal, keys.normal, sizeof boundary->normal);
    if (!scene_face_normalise(reader, path, boundary->normal, inner))
        return;
    set_axes(boundary, reader->axis_count);
    if (json_object_get(given, "min") != NULL) {
        from_corners(reader, path, &keys, boundary);
        return;
    }
    memcpy(boundary->point, keys.point, sizeof boundary->point);
    memcpy(boundary->size, keys.size, sizeof boundary->size);
}

json_t *scene_face_schema(void)
{
    return scene_fields_schema(face_fields);
}

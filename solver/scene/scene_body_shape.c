/* SPDX-License-Identifier: Apache-2.0 */
/* Shapes of bodies that are lists of points (polygon, points), and the rotation of a body. */
#include "scene/scene_body.h"

#include "seeding/seeding_polygon.h"
#include "seeding/seeding_shape.h"
#include "talus/scene.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { POINT_MAX = 5000000 };

#define AT(member) offsetof(struct talus_body, member)

/* True for an array of `minimum` to `maximum` entries; a mistake otherwise. */
static bool check_count(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given, size_t minimum, size_t maximum)
{
    const size_t count = json_array_size(given);
    if (!json_is_array(given))
        scene_mistake(reader, path, "type", given, json_string("array"),
                      "expected an array, not %s", scene_type_word(given));
    else if (count < minimum || count > maximum)
        scene_mistake(reader, path, "length", NULL, NULL, "expected %zu to %zu entries, not %zu",
                      minimum, maximum, count);
    return json_is_array(given) && count >= minimum && count <= maximum;
}

static const struct scene_field place_field = {.key = "place", .unit = "m"};

/* Reads [[x, y], ...] into a new array with `stride` numbers a point (0 beyond the dimension).
 * NULL after a mistake. */
static double *read_places(struct scene_reader *reader, const struct scene_path *path,
                           const json_t *given, size_t minimum, size_t maximum, size_t stride,
                           json_t *effective)
{
    if (!check_count(reader, path, given, minimum, maximum))
        return NULL;
    const size_t count = json_array_size(given);
    double *places = calloc(count * stride, sizeof *places);
    json_t *list = json_array();
    bool valid = places != NULL;
    reader->out_of_memory |= places == NULL;
    for (size_t index = 0; index < count && valid; index++) {
        struct scene_path here = {.parent = path, .index = index};
        double place[3] = {0.0, 0.0, 0.0};
        json_t *entry = NULL;
        valid = scene_vector_read(reader, &here, &place_field, json_array_get(given, index), place,
                                  &entry);
        if (valid)
            memcpy(places + index * stride, place, stride * sizeof *places);
        if (valid && json_array_append_new(list, entry) != 0)
            reader->out_of_memory = true;
    }
    scene_put(reader, effective, path->key, list);
    if (valid)
        return places;
    free(places);
    return NULL;
}

static void check_polygon(struct scene_reader *reader, const struct scene_path *path,
                          const struct talus_body *body)
{
    size_t first, second;
    if (reader->axis_count == 1 || reader->axis_count == 3)
        scene_mistake(reader, path, "contradiction", NULL, NULL, "a polygon needs two dimensions");
    else if (polygon_crosses_itself(body->vertices, body->vertex_count, &first, &second))
        scene_mistake(reader, path, "contradiction", NULL, NULL,
                      "the side after vertex %zu %s the side after vertex %zu", first,
                      first == second ? "has no length, as has" : "meets or crosses", second);
}

static void read_vertices(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *target, json_t *effective)
{
    struct talus_body *body = target;
    body->vertices = read_places(reader, path, given, 3, SEEDING_VERTEX_MAX, 2, effective);
    if (body->vertices == NULL)
        return;
    body->vertex_count = json_array_size(given);
    check_polygon(reader, path, body);
}

static json_t *places_schema(size_t minimum, size_t maximum)
{
    return json_pack("{s:s, s:i, s:i, s:o}", "type", "array", "minItems", (int)minimum, "maxItems",
                     (int)maximum, "items",
                     scene_axes_schema(scene_number_schema(&place_field), 0));
}

static json_t *vertices_schema(void)
{
    return places_schema(3, SEEDING_VERTEX_MAX);
}

const struct scene_field scene_polygon_fields[] = {
    {.key = "vertices",
     .kind = SCENE_CUSTOM,
     .unit = "m",
     .required = true,
     .read = read_vertices,
     .schema = vertices_schema,
     .meaning = "corners [[x, y], ...], either way round; sides must not cross"},
    {.key = NULL},
};

static void read_positions(struct scene_reader *reader, const struct scene_path *path,
                           const json_t *given, void *target, json_t *effective)
{
    struct talus_body *body = target;
    body->point_positions = read_places(reader, path, given, 1, POINT_MAX, 3, effective);
    if (body->point_positions != NULL)
        body->point_count = json_array_size(given);
}

static json_t *positions_schema(void)
{
    return places_schema(1, POINT_MAX);
}

static const struct scene_field volume_field = {
    .key = "volume", .unit = "m^3", .maximum = INFINITY, .above_minimum = true};

static void read_volumes(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, void *target, json_t *effective)
{
    struct talus_body *body = target;
    json_t *list = json_array();
    const size_t count = body->point_count;
    scene_put(reader, effective, path->key, list);
    if (count == 0 || !check_count(reader, path, given, 1, POINT_MAX))
        return; /* without positions there is nothing to compare with */
    if (json_array_size(given) != count)
        scene_mistake(reader, path, "contradiction", NULL, NULL, "%zu volumes for %zu positions",
                      json_array_size(given), count);
    body->point_volumes = calloc(count, sizeof *body->point_volumes);
    if (body->point_volumes == NULL) {
        reader->out_of_memory = true;
        return;
    }
    for (size_t index = 0; index < json_array_size(given); index++) {
        struct scene_path here = {.parent = path, .index = index};
        double volume;
        if (!scene_number_read(reader, &here, &volume_field, json_array_get(given, index), &volume))
            return;
        if (index < count)
            body->point_volumes[index] = volume;
        if (json_array_append_new(list, json_real(volume)) != 0)
            reader->out_of_memory = true;
    }
}

static json_t *volumes_schema(void)
{
    return json_pack("{s:s, s:i, s:i, s:o}", "type", "array", "minItems", 1, "maxItems",
                     (int)POINT_MAX, "items", scene_number_schema(&volume_field));
}

const struct scene_field scene_points_fields[] = {
    {.key = "positions",
     .kind = SCENE_CUSTOM,
     .unit = "m",
     .required = true,
     .read = read_positions,
     .schema = positions_schema,
     .meaning = "one vector a particle"},
    {.key = "volumes",
     .kind = SCENE_CUSTOM,
     .unit = "m^3",
     .required = true,
     .read = read_volumes,
     .schema = volumes_schema,
     .meaning = "one number a particle: m^3, m^2 per metre in 2D, m per m^2 in 1D"},
    {.key = NULL},
};

static const struct scene_field turn_fields[] = {
    {.key = "angle",
     .kind = SCENE_NUMBER,
     .unit = "deg",
     .minimum = -360.0,
     .maximum = 360.0,
     .required = true,
     .default_value = NAN,
     .offset = AT(rotate_angle_deg),
     .meaning = "counterclockwise in 2D, right-handed about the axis in 3D"},
    {.key = "about",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = AT(rotate_about),
     .meaning = "a point that stays"},
    {.key = "axis",
     .kind = SCENE_VECTOR,
     .unit = "1",
     .default_value = NAN,
     .offset = AT(rotate_axis),
     .meaning = "3D: direction of the axis, any length"},
    {.key = NULL},
};

static void finish_axis(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given, struct talus_body *body)
{
    struct scene_path here = {.parent = path, .key = "axis"};
    const bool known = json_object_get(given, "axis") != NULL;
    double *axis = body->rotate_axis, square = 0.0;
    if (reader->axis_count == 1)
        scene_mistake(reader, path, "contradiction", NULL, NULL, "in one dimension nothing turns");
    else if (reader->axis_count == 2 && known)
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "in two dimensions a body turns in the plane");
    else if (reader->axis_count == 3 && !known)
        scene_mistake(reader, &here, "incomplete", NULL, NULL, "'axis' is required in 3D");
    for (size_t k = 0; k < 3; k++)
        square += axis[k] * axis[k];
    if (known && square == 0.0)
        scene_mistake(reader, &here, "direction", NULL, NULL, "the axis has no direction");
    for (size_t k = 0; k < 3; k++)
        axis[k] = reader->axis_count == 3 ? axis[k] / sqrt(square) : (double)(k == 2);
}

void scene_body_rotate_read(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, void *target, json_t *effective)
{
    struct talus_body *body = target;
    if (given == NULL)
        return;
    json_t *inner = json_object();
    scene_fields_read(reader, path, turn_fields, given, body, inner);
    scene_put(reader, effective, path->key, inner);
    if (json_is_object(given))
        finish_axis(reader, path, given, body);
}

json_t *scene_body_rotate_schema(void)
{
    return scene_fields_schema(turn_fields);
}

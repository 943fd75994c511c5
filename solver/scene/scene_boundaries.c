/* SPDX-License-Identifier: Apache-2.0 */
/* Boundaries: planes, faces and boxes, and what they do. */
#include "scene/scene_boundary.h"
#include "scene/scene_face.h"
#include "scene/scene_sections.h"

#include "seeding/seeding.h"

#include <string.h>

#define AT(member) offsetof(struct boundary_keys, boundary.member)

static const char *const wall_words[] = {"stop", "keep", NULL};
static const char *const area_words[] = {"tributary", "source", NULL};
static const char *const face_words[] = {"x_min", "x_max", "y_min", "y_max",
                                         "z_min", "z_max", NULL};

static const struct scene_field plane_fields[] = {
    {.key = "point",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = AT(point),
     .meaning = "a point of the plane"},
    {.key = "normal",
     .kind = SCENE_VECTOR,
     .unit = "1",
     .required = true,
     .default_value = NAN,
     .offset = AT(normal),
     .meaning = "points into the material; any length"},
    {.key = NULL},
};

static const struct scene_field box_fields[] = {
    {.key = "min",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = AT(box_min),
     .meaning = "lower corner"},
    {.key = "max",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .required = true,
     .default_value = NAN,
     .offset = AT(box_max),
     .meaning = "upper corner"},
    {.key = NULL},
};

static void read_face(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *target, json_t *effective)
{
    scene_face_read(reader, path, given, &((struct boundary_keys *)target)->boundary, effective);
}

static void read_faces(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *target, json_t *effective)
{
    struct boundary_keys *keys = target;
    const char *words[7] = {NULL};
    if (given == NULL)
        return;
    if (!json_is_object(given)) {
        scene_mistake(reader, path, "type", given, json_string("object"),
                      "expected an object, not %s", scene_type_word(given));
        return;
    }
    size_t axis_count = reader->axis_count > 0 ? reader->axis_count : 3;
    memcpy(words, face_words, 2 * axis_count * sizeof *words);
    json_t *inner = json_object();
    scene_put(reader, effective, path->key, inner);
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)given, key, value)
    { /* the iterator does not write */
        struct scene_path here = {.parent = path, .key = key};
        int face = 0;
        while (words[face] != NULL && strcmp(words[face], key) != 0)
            face++;
        if (words[face] == NULL) {
            bool other = strcmp(key, "y_min") == 0 || strcmp(key, "y_max") == 0 ||
                         strcmp(key, "z_min") == 0 || strcmp(key, "z_max") == 0;
            scene_mistake(reader, &here, other ? "dimension" : "unknown_key", NULL,
                          scene_word_list(words), "unknown face '%.60s'", key);
            if (!other)
                continue;
            face = 0; /* nobody reads a scene with a mistake */
        }
        json_t *entry = json_object();
        scene_fields_read(reader, &here, scene_condition_fields, value, &keys->faces[face], entry);
        scene_condition_finish(reader, &here, value, &keys->faces[face],
                               &keys->boundary.faces[face]);
        scene_put(reader, inner, key, entry);
    }
}

static json_t *faces_schema(void)
{
    json_t *properties = json_object();
    for (const char *const *word = face_words; *word != NULL; word++) {
        json_t *face = scene_fields_schema(scene_condition_fields);
        scene_condition_rules_add(face);
        (void)json_object_set_new(properties, *word, face);
    }
    return json_pack("{s:s, s:b, s:o}", "type", "object", "additionalProperties", 0, "properties",
                     properties);
}

static const struct scene_field force_field = {.key = "tension_release", .unit = "N"};

static void read_tension(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, void *target, json_t *effective)
{
    struct talus_boundary *boundary = &((struct boundary_keys *)target)->boundary;
    if (json_is_number(given)) {
        boundary->tension_release =
            scene_number_read(reader, path, &force_field, given, &boundary->tension_force);
        scene_put(reader, effective, path->key, json_real(boundary->tension_force));
    } else if (given == NULL || json_is_boolean(given)) {
        boundary->tension_release = json_is_true(given);
        scene_put(reader, effective, path->key, json_boolean(boundary->tension_release));
    } else {
        scene_mistake(reader, path, "type", given, json_string("boolean or number"),
                      "expected true, false or a force in N, not %s", scene_type_word(given));
    }
}

static json_t *tension_schema(void)
{
    return json_pack("{s:[{s:s}, o]}", "oneOf", "type", "boolean",
                     scene_number_schema(&force_field));
}

static void read_body(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *target, json_t *effective)
{
    struct talus_boundary *boundary = &((struct boundary_keys *)target)->boundary;
    boundary->body_index = -1;
    if (given == NULL)
        return;
    boundary->body_index = scene_body_find(reader, path, given);
    if (boundary->body_index >= 0)
        scene_put(reader, effective, path->key, json_string(json_string_value(given)));
}

static json_t *body_schema(void)
{
    return json_pack("{s:s}", "type", "string");
}

const struct scene_field scene_boundary_fields[] = {
    {.key = "name",
     .kind = SCENE_NAME,
     .unit = "1",
     .offset = offsetof(struct boundary_keys, name),
     .meaning = "name in reactions and probes; default boundary_INDEX"},
    {.key = "plane",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .required = true,
     .alternative = "shape",
     .fields = plane_fields,
     .meaning = "nodes on it and behind it"},
    {.key = "face",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .alternative = "shape",
     .read = read_face,
     .schema = scene_face_schema,
     .meaning = "nodes in a rectangle only"},
    {.key = "box",
     .kind = SCENE_OBJECT,
     .unit = "1",
     .required = true,
     .alternative = "shape",
     .fields = box_fields,
     .meaning = "obstacle with sides along the axes"},
    SCENE_CONDITION_FIELDS,
    {.key = "faces",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_faces,
     .schema = faces_schema,
     .meaning = "conditions of single faces of a box"},
    {.key = "wall",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = wall_words,
     .offset = AT(wall),
     .meaning = "stop: the velocity into the wall is taken away at once; keep: stress stops it"},
    {.key = "tension_release",
     .kind = SCENE_CUSTOM,
     .unit = "N",
     .read = read_tension,
     .schema = tension_schema,
     .meaning = "material may leave the boundary; a number: as soon as the push is below it"},
    {.key = "peak_window",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .maximum = INFINITY,
     .offset = AT(peak_window),
     .meaning = "peaks are taken of the running mean over this time; 0: of single steps"},
    {.key = "moment_about",
     .kind = SCENE_VECTOR,
     .unit = "m",
     .default_value = NAN,
     .offset = offsetof(struct boundary_keys, moment_about),
     .meaning = "point of reference of moments; default the plane's point, the face's centre, the "
                "centre of a box's base"},
    {.key = "area_rule",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = area_words,
     .offset = AT(area_source_rule),
     .storage = SCENE_STORE_BOOLEAN,
     .meaning = "contact area: tributary areas, or h^2 a node (Mast 2013, eq. 7.15)"},
    {.key = "body",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = read_body,
     .schema = body_schema,
     .meaning = "with eliminate: takes out particles of this body only"},
    {.key = "velocity",
     .kind = SCENE_CUSTOM,
     .unit = "m/s",
     .read = scene_boundary_velocity_read,
     .schema = scene_boundary_velocity_schema,
     .meaning = "with velocity: how the material moves; components may be [[t, value], ...]"},
    {.key = "components",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .read = scene_boundary_components_read,
     .schema = scene_boundary_components_schema,
     .meaning = "with velocity: axes on which it is prescribed; default all"},
    {.key = "stays",
     .kind = SCENE_BOOLEAN,
     .unit = "1",
     .offset = AT(stays),
     .meaning = "with velocity: the boundary does not move along with the material"},
    {.key = "from",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .minimum = -INFINITY,
     .maximum = INFINITY,
     .default_value = NAN,
     .offset = offsetof(struct boundary_keys, from),
     .meaning = "the boundary acts from this time on; default always"},
    {.key = "until",
     .kind = SCENE_NUMBER,
     .unit = "s",
     .minimum = -INFINITY,
     .maximum = INFINITY,
     .default_value = NAN,
     .offset = offsetof(struct boundary_keys, until),
     .meaning = "the boundary acts up to this time (a gate); default always"},
    {.key = "phase", .unsupported = true},
    {.key = NULL},
};

/* Moments of a box are about the centre of the side on which it stands: the lower one along
 * gravity, or along y (x in 1D) without gravity. */
static void default_moment(const struct scene_reader *reader, struct talus_boundary *boundary)
{
    enum talus_axis vertical = seeding_vertical_axis(reader->scene);
    size_t base = vertical != TALUS_NO_AXIS ? (size_t)vertical : (reader->axis_count > 1 ? 1 : 0);
    bool upside_down = vertical != TALUS_NO_AXIS && reader->scene->gravity[vertical] > 0.0;
    memcpy(boundary->moment_about, boundary->point, sizeof boundary->moment_about);
    if (boundary->shape != TALUS_BOUNDARY_BOX)
        return;
    for (size_t k = 0; k < 3; k++)
        boundary->moment_about[k] = 0.5 * (boundary->box_min[k] + boundary->box_max[k]);
    boundary->moment_about[base] = upside_down ? boundary->box_max[base] : boundary->box_min[base];
}

static void finish_moment(struct scene_reader *reader, struct boundary_keys *keys,
                          json_t *effective)
{
    struct talus_boundary *boundary = &keys->boundary;
    if (!isnan(keys->moment_about[0])) {
        memcpy(boundary->moment_about, keys->moment_about, sizeof boundary->moment_about);
        return;
    }
    default_moment(reader, boundary);
    json_t *list = json_array();
    for (size_t k = 0; k < reader->axis_count; k++) {
        double place = isfinite(boundary->moment_about[k]) ? boundary->moment_about[k] : 0.0;
        if (json_array_append_new(list, json_real(place)) != 0)
            reader->out_of_memory = true;
    }
    scene_put(reader, effective, "moment_about", list);
}

/* A box: six faces with the boundary's condition unless they have their own. */
static void finish_box(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, struct boundary_keys *keys)
{
    struct talus_boundary *boundary = &keys->boundary;
    struct scene_path shape = {.parent = path, .key = "box"};
    struct scene_path corner = {.parent = &shape, .key = "max"};
    struct talus_boundary_face common = {.condition_index = 0};
    boundary->face_count = 2 * reader->axis_count;
    scene_condition_finish(reader, path, given, &keys->condition, &common);
    for (size_t face = 0; face < boundary->face_count; face++) {
        bool overridden = keys->faces[face].index != SIZE_MAX;
        if (!overridden)
            boundary->faces[face] = common;
        struct scene_path faces = {.parent = path, .key = "faces"};
        struct scene_path here = {.parent = &faces, .key = face_words[face]};
        if (overridden && keys->condition.index != SIZE_MAX &&
            scene_condition_eliminates(keys->faces[face].index) !=
                scene_condition_eliminates(keys->condition.index))
            scene_mistake(reader, &here, "contradiction", NULL, NULL,
                          "a box takes particles out with all of its faces or with none");
    }
    for (size_t k = 0; k < reader->axis_count; k++) {
        struct scene_path here = {.parent = &corner, .index = k};
        if (boundary->box_max[k] <= boundary->box_min[k])
            scene_mistake(reader, &here, "order", NULL, NULL, "max %g must be above min %g",
                          boundary->box_max[k], boundary->box_min[k]);
    }
}

static void finish_shape(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, struct boundary_keys *keys, json_t *effective)
{
    struct talus_boundary *boundary = &keys->boundary;
    struct scene_path faces = {.parent = path, .key = "faces"};
    if (json_object_get(given, "box") != NULL) {
        boundary->shape = TALUS_BOUNDARY_BOX;
        finish_box(reader, path, given, keys);
        return;
    }
    boundary->face_count = 1;
    scene_condition_finish(reader, path, given, &keys->condition, &boundary->faces[0]);
    if (json_object_get(given, "faces") != NULL)
        scene_mistake(reader, &faces, "contradiction", NULL, NULL, "only a box has 'faces'");
    if (json_object_get(given, "face") != NULL) {
        boundary->shape = TALUS_BOUNDARY_FACE;
        return;
    }
    struct scene_path plane = {.parent = path, .key = "plane"};
    scene_face_normalise(reader, &plane, boundary->normal, json_object_get(effective, "plane"));
}

/* Bodies share one velocity field: only particles can be told apart, not what moves a node. */
static void check_filter(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, const struct boundary_keys *keys)
{
    struct scene_path here = {.parent = path, .key = "body"};
    if (json_object_get(given, "body") != NULL && keys->condition.index != SIZE_MAX &&
        !scene_condition_eliminates(keys->condition.index))
        scene_mistake(reader, &here, "unsupported", NULL, NULL,
                      "only the condition \"eliminate\" can act on one body in this build");
}

static void read_boundary(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *item, json_t *effective)
{
    struct boundary_keys keys;
    memset(&keys, 0, sizeof keys);
    scene_condition_init(&keys.condition);
    for (size_t face = 0; face < 6; face++)
        scene_condition_init(&keys.faces[face]);
    for (size_t k = 0; k < reader->axis_count; k++)
        keys.boundary.box_min[k] = keys.boundary.box_max[k] = keys.boundary.normal[k] = NAN;
    keys.moment_about[0] = keys.from = keys.until = NAN;
    scene_fields_read(reader, path, scene_boundary_fields, given, &keys, effective);
    finish_shape(reader, path, given, &keys, effective);
    scene_boundary_motion_finish(reader, path, given, &keys, effective);
    check_filter(reader, path, given, &keys);
    finish_moment(reader, &keys, effective);
    keys.boundary.name = scene_entry_name(reader, path, keys.name, "boundary", effective);
    memcpy(item, &keys.boundary, sizeof keys.boundary);
}

void scene_boundaries_read(struct scene_reader *reader, const struct scene_path *path,
                           const json_t *given, void *target, json_t *effective)
{
    struct talus_scene *scene = target;
    void *items;
    const char *names[SCENE_ENTRY_MAX];
    scene->boundary_count = scene_list_read(reader, path, given, 0, sizeof(struct talus_boundary),
                                            &items, effective, read_boundary);
    scene->boundaries = items;
    for (size_t index = 0; index < scene->boundary_count; index++)
        names[index] = scene->boundaries[index].name;
    scene_names_check(reader, path, names, scene->boundary_count);
}

json_t *scene_boundaries_schema(void)
{
    json_t *schema = scene_list_schema(scene_boundary_fields, 0);
    json_t *entry = json_object_get(schema, "items");
    scene_condition_rules_add(entry);
    for (size_t index = 0; scene_condition_name(index) != NULL; index++) {
        static const char *const filter[] = {"body", NULL};
        if (!scene_condition_eliminates(index)) /* check_filter */
            scene_rule_add(entry, "condition", scene_condition_name(index), filter, filter + 1);
    }
    return schema;
}

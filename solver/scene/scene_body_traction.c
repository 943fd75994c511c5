/* SPDX-License-Identifier: Apache-2.0 */
/* Loads on faces of a body. */
#include "scene/scene_body.h"
#include "scene/scene_sections.h"
#include "scene/scene_time_table.h"

#include "state/traction_layout.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define AT(member) offsetof(struct talus_traction, member)

static const char *const kind_words[] = {"dead", "fibre", "normal", NULL};

static const struct scene_field value_field = {
    .key = "value",
    .kind = SCENE_VECTOR,
    .unit = "Pa",
    .minimum = -1e15,
    .maximum = 1e15,
    .meaning = "force per area",
};

static const struct scene_field pressure_field = {
    .key = "pressure",
    .kind = SCENE_NUMBER,
    .unit = "Pa",
    .minimum = -1e15,
    .maximum = 1e15,
    .meaning = "positive into the body",
};

static void read_value(struct scene_reader *reader, const struct scene_path *path,
                       const json_t *given, void *target, json_t *effective)
{
    struct talus_traction *traction = target;
    json_t *value = NULL;
    if (scene_timed_vector_read(reader, path, &value_field, given, traction->value, traction->table,
                                &value))
        scene_put(reader, effective, path->key, value);
}

static json_t *value_schema(void)
{
    return scene_timed_vector_schema(&value_field);
}

static void read_pressure(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *target, json_t *effective)
{
    struct talus_traction *traction = target;
    json_t *value = NULL;
    traction->is_pressure = true;
    if (scene_timed_number_read(reader, path, &pressure_field, given, &traction->value[0],
                                &traction->table[0], &value))
        scene_put(reader, effective, path->key, value);
}

static json_t *pressure_schema(void)
{
    return scene_timed_number_schema(&pressure_field);
}

/* Words of the faces of shapes that have a few. */
static const char *const box_words[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max", NULL};
static const char *const sphere_words[] = {"outside", NULL};
static const char *const cylinder_words[] = {"outside", "from", "to", NULL};

/* A prefix and a number with at most five digits; returns what follows, or NULL. */
static const char *read_index(const char *text, const char *prefix, size_t *index)
{
    enum { DIGIT_MAX = 5 };
    const size_t length = strlen(prefix);
    if (text == NULL || strncmp(text, prefix, length) != 0)
        return NULL;
    const size_t digits = strspn(text + length, "0123456789");
    *index = (size_t)strtoul(text + length, NULL, 10);
    return digits > 0 && digits <= DIGIT_MAX ? text + length + digits : NULL;
}

/* "side_A" or "side_A_to_B". */
static bool read_sides(const char *word, size_t side_count, struct talus_traction *traction)
{
    const char *rest = read_index(word, "side_", &traction->face);
    traction->last_face = traction->face;
    if (rest != NULL && rest[0] != '\0')
        rest = read_index(rest, "_to_", &traction->last_face);
    return rest != NULL && rest[0] == '\0' && traction->face < side_count &&
           traction->last_face < side_count;
}

/* Whether this is the name of a face of some body. */
static bool names_face(const char *word)
{
    struct talus_traction traction;
    const char *const *const lists[] = {box_words, sphere_words, cylinder_words};
    for (size_t list = 0; list < sizeof lists / sizeof lists[0]; list++) {
        for (const char *const *entry = lists[list]; *entry != NULL; entry++) {
            if (strcmp(*entry, word) == 0)
                return true;
        }
    }
    return read_sides(word, SIZE_MAX, &traction);
}

static void read_face(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, void *target, json_t *effective)
{
    (void)target; /* the face is read when the shape of the body is known */
    if (!json_is_string(given))
        scene_mistake(reader, path, "type", given, json_string("string"),
                      "expected the name of a face, not %s", scene_type_word(given));
    else if (!names_face(json_string_value(given)))
        scene_mistake(reader, path, "unknown_value", given, NULL,
                      "there is no face of that name: box: x_min ... z_max; polygon: side_0, "
                      "side_3_to_7, ...; sphere: outside; cylinder: outside, from, to");
    else
        scene_put(reader, effective, path->key, json_string(json_string_value(given)));
}

static json_t *face_schema(void)
{
    return json_pack("{s:s, s:s}", "type", "string", "pattern",
                     "^([xyz]_(min|max)|side_[0-9]{1,5}(_to_[0-9]{1,5})?|outside|from|to)$");
}

static const struct scene_field traction_fields[] = {
    {.key = "face",
     .kind = SCENE_CUSTOM,
     .unit = "1",
     .required = true,
     .read = read_face,
     .schema = face_schema,
     .meaning = "box: x_min ... z_max; polygon: side_0 (from vertex 0 to 1), side_3_to_7, ...; "
                "sphere: outside; cylinder: outside, from, to"},
    {.key = "value",
     .kind = SCENE_CUSTOM,
     .unit = "Pa",
     .required = true,
     .alternative = "load",
     .read = read_value,
     .schema = value_schema,
     .meaning = "force per area at t = 0"},
    {.key = "pressure",
     .kind = SCENE_CUSTOM,
     .unit = "Pa",
     .required = true,
     .alternative = "load",
     .read = read_pressure,
     .schema = pressure_schema,
     .meaning = "positive into the body"},
    {.key = "kind",
     .kind = SCENE_CHOICE,
     .unit = "1",
     .choices = kind_words,
     .offset = AT(kind),
     .meaning = "dead: keeps its direction; fibre: turns with the material; normal: a pressure on "
                "the surface as it is now"},
    {.key = NULL},
};

static void find_side(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, const struct talus_body *body,
                      struct talus_traction *traction)
{
    if (body->vertex_count > 0 &&
        !read_sides(json_string_value(given), body->vertex_count, traction))
        scene_mistake(reader, path, "contradiction", given, NULL,
                      "expected \"side_0\" ... \"side_%zu\" (side k runs from vertex k to the "
                      "next), or several as \"side_3_to_7\"",
                      body->vertex_count - 1);
}

static void find_word(struct scene_reader *reader, const struct scene_path *path,
                      const json_t *given, const struct talus_body *body,
                      struct talus_traction *traction)
{
    const char *words[7] = {NULL};
    const size_t axes = reader->axis_count > 0 ? reader->axis_count : 3;
    if (body->shape == TALUS_BODY_BOX)
        memcpy(words, box_words, 2 * axes * sizeof *words);
    else if (body->shape == TALUS_BODY_SPHERE)
        memcpy(words, sphere_words, sizeof sphere_words);
    else
        memcpy(words, cylinder_words, sizeof cylinder_words);
    for (size_t face = 0; words[face] != NULL; face++) {
        if (strcmp(words[face], json_string_value(given)) == 0) {
            traction->face = face;
            return;
        }
    }
    scene_mistake(reader, path, "contradiction", given, scene_word_list(words),
                  "this body has no such face");
}

/* What is unclear is refused: a clip takes away an unknown part of what is not a box. */
static bool has_faces(struct scene_reader *reader, const struct scene_path *path,
                      const struct talus_body *body)
{
    bool clipped = false;
    for (size_t k = 0; k < reader->axis_count; k++)
        clipped |= body->clip_min[k] > -INFINITY || body->clip_max[k] < INFINITY;
    if (body->shape == TALUS_BODY_POINTS)
        scene_mistake(reader, path, "contradiction", NULL, NULL,
                      "a list of points has no faces that could be loaded");
    else if (clipped && body->shape != TALUS_BODY_BOX)
        scene_mistake(reader, path, "contradiction", NULL, NULL,
                      "of bodies with a clip only a box has faces that can be loaded");
    else if (reader->axis_count == 1 && body->shape != TALUS_BODY_BOX)
        scene_mistake(reader, path, "contradiction", NULL, NULL,
                      "in one dimension only a box has faces that can be loaded");
    else
        return true;
    return false;
}

static void finish_traction(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, const struct talus_body *body,
                            struct talus_traction *traction)
{
    struct scene_path face = {.parent = path, .key = "face"};
    struct scene_path kind = {.parent = path, .key = "kind"};
    const json_t *word = json_object_get(given, "face");
    if (json_is_string(word) && names_face(json_string_value(word)) &&
        has_faces(reader, &face, body)) {
        if (body->shape == TALUS_BODY_POLYGON)
            find_side(reader, &face, word, body, traction);
        else
            find_word(reader, &face, word, body, traction);
    }
    if (traction->kind == TALUS_TRACTION_NORMAL && !traction->is_pressure)
        scene_mistake(reader, &kind, "contradiction", NULL, NULL,
                      "\"normal\" takes a 'pressure', not a 'value'");
    else if (traction->kind != TALUS_TRACTION_DEAD &&
             reader->scene->solver.strain != TALUS_STRAIN_FINITE)
        scene_mistake(reader, &kind, "contradiction", NULL, NULL,
                      "a load that follows the deformation needs finite strain");
}

static void read_traction(struct scene_reader *reader, const struct scene_path *path,
                          const json_t *given, void *item, json_t *effective)
{
    scene_fields_read(reader, path, traction_fields, given, item, effective);
}

void scene_body_traction_read(struct scene_reader *reader, const struct scene_path *path,
                              const json_t *given, void *target, json_t *effective)
{
    struct talus_body *body = target;
    void *items = NULL;
    if (json_array_size(given) > TRACTION_MAX) {
        scene_mistake(reader, path, "length", NULL, json_integer(TRACTION_MAX),
                      "a body has at most %d tractions", TRACTION_MAX);
        return;
    }
    body->traction_count = scene_list_read(reader, path, given, 0, sizeof(struct talus_traction),
                                           &items, effective, read_traction);
    body->tractions = items;
    for (size_t index = 0; index < body->traction_count; index++) {
        struct scene_path here = {.parent = path, .index = index};
        finish_traction(reader, &here, json_array_get(given, index), body, &body->tractions[index]);
    }
}

json_t *scene_body_traction_schema(void)
{
    json_t *schema = scene_list_schema(traction_fields, 0);
    (void)json_object_set_new(schema, "maxItems", json_integer(TRACTION_MAX));
    return schema;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Reads an object by its table: keys, alternatives, then each field by its kind. */
#include "scene/scene_field.h"

#include <assert.h>
#include <string.h>

enum { KEY_MAX = 128 };

const struct scene_field *scene_field_find(const struct scene_field *table, const char *key)
{
    for (; table->key != NULL; table++) {
        if (strcmp(table->key, key) == 0)
            return table;
    }
    return NULL;
}

static void check_keys(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *table, const json_t *object)
{
    const char *words[KEY_MAX + 1] = {NULL};
    size_t count = 0;
    for (const struct scene_field *field = table; field->key != NULL; field++) {
        if (!field->unsupported && count < KEY_MAX)
            words[count++] = field->key;
    }
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    { /* the iterator does not write */
        const struct scene_field *field = scene_field_find(table, key);
        struct scene_path here = {.parent = path, .key = key};
        const char *nearest = field == NULL ? scene_suggest(key, words) : NULL;
        if (nearest != NULL)
            scene_mistake(reader, &here, "unknown_key", NULL, scene_word_list(words),
                          "unknown key '%.60s': did you mean '%s'?", key, nearest);
        else if (field == NULL)
            scene_mistake(reader, &here, "unknown_key", NULL, scene_word_list(words),
                          "unknown key '%.60s'", key);
        else if (field->unsupported)
            scene_mistake(reader, &here, "unsupported", value, NULL,
                          "'%s' is not supported by this build", key);
    }
}

bool scene_field_in_group(const struct scene_field *field, const char *group)
{
    return (field->alternative != NULL && strcmp(field->alternative, group) == 0) ||
           (field->also != NULL && strcmp(field->also, group) == 0);
}

/* True if another field of the same group of alternatives is given. */
static bool other_is_given(const struct scene_field *table, const struct scene_field *field,
                           const json_t *object)
{
    for (const struct scene_field *other = table; other->key != NULL; other++) {
        if (other != field && field->alternative != NULL &&
            scene_field_in_group(other, field->alternative) &&
            json_object_get(object, other->key) != NULL)
            return true;
    }
    return false;
}

struct group_check {
    struct scene_reader *reader;
    const struct scene_path *path;
    const json_t *object;
};

static void check_group(const struct scene_field *table, const char *group, bool required,
                        void *context)
{
    const struct group_check *check = context;
    const struct scene_field *given = NULL;
    const char *words[KEY_MAX + 1] = {NULL}, *first = NULL;
    size_t count = 0;
    for (const struct scene_field *field = table; field->key != NULL; field++) {
        if (!scene_field_in_group(field, group))
            continue;
        if (first == NULL && field->also == NULL)
            first = field->key;
        if (!field->unsupported && count < KEY_MAX)
            words[count++] = field->key;
        if (json_object_get(check->object, field->key) == NULL)
            continue;
        struct scene_path here = {.parent = check->path, .key = field->key};
        if (given != NULL && !given->unsupported && !field->unsupported)
            scene_mistake(check->reader, &here, "alternative", NULL, scene_word_list(words),
                          "'%s' and '%s' exclude each other", given->key, field->key);
        given = field;
    }
    struct scene_path here = {.parent = check->path, .key = first};
    if (given == NULL && required)
        scene_mistake(check->reader, &here, "required", NULL, scene_word_list(words),
                      "one of these keys is required (%s)", group);
}

/* True if no field before this one belongs to the group. */
static bool opens_group(const struct scene_field *table, const struct scene_field *field,
                        const char *group)
{
    for (; group != NULL && table < field; table++) {
        if (scene_field_in_group(table, group))
            return false;
    }
    return group != NULL;
}

void scene_groups_visit(const struct scene_field *table,
                        void (*visit)(const struct scene_field *table, const char *group,
                                      bool required, void *context),
                        void *context)
{
    for (const struct scene_field *field = table; field->key != NULL; field++) {
        if (opens_group(table, field, field->alternative))
            visit(table, field->alternative, field->required, context);
        if (opens_group(table, field, field->also))
            visit(table, field->also, field->required, context);
    }
}

/* Keys that are given without the one that they belong to. */
static void check_needs(struct scene_reader *reader, const struct scene_path *path,
                        const struct scene_field *table, const json_t *object)
{
    for (; table->key != NULL; table++) {
        if (table->needs == NULL || json_object_get(object, table->key) == NULL ||
            json_object_get(object, table->needs) != NULL)
            continue;
        struct scene_path here = {.parent = path, .key = table->needs};
        scene_mistake(reader, &here, "required", NULL, NULL, "'%s' needs '%s'", table->key,
                      table->needs);
    }
}

static void store(const struct scene_field *field, void *target, const void *value, size_t bytes)
{
    if (field->offset != SCENE_NOWHERE)
        memcpy((char *)target + field->offset, value, bytes);
}

/* Stores an index or truth value the way the field wants it. */
static void store_whole(const struct scene_field *field, void *target, int value)
{
    size_t size = (size_t)value;
    double number = value;
    bool truth = value != 0;
    if (field->storage == SCENE_STORE_SIZE)
        store(field, target, &size, sizeof size);
    else if (field->storage == SCENE_STORE_DOUBLE)
        store(field, target, &number, sizeof number);
    else if (field->kind == SCENE_BOOLEAN || field->storage == SCENE_STORE_BOOLEAN)
        store(field, target, &truth, sizeof truth);
    else
        store(field, target, &value, sizeof value);
}

bool scene_field_is_default(const struct scene_field *field, const void *target)
{
    double number;
    int index;
    switch (field->kind) {
    case SCENE_NUMBER:
        memcpy(&number, (const char *)target + field->offset, sizeof number);
        return number == field->default_value;
    case SCENE_CHOICE:
        memcpy(&index, (const char *)target + field->offset, sizeof index);
        return index == (int)field->default_value;
    case SCENE_OBJECT:
        for (const struct scene_field *inner = field->fields; inner->key != NULL; inner++) {
            if (!scene_field_is_default(inner, target))
                return false;
        }
        return true;
    case SCENE_BOOLEAN:
    case SCENE_TEXT:
    case SCENE_NAME:
    case SCENE_VECTOR:
    case SCENE_CUSTOM:
        break;
    }
    assert(!"a kind whose default is not compared");
    return false;
}

struct place { /* one field of one object */
    struct scene_reader *reader;
    struct scene_path path;
    const struct scene_field *field;
    const json_t *given;
    bool use_default; /* not given, nor is an alternative */
    void *target;
    json_t *effective;
};

static void read_number(const struct place *place)
{
    const struct scene_field *field = place->field;
    double value = NAN;
    bool known = place->given != NULL;
    if (known) {
        known = scene_number_read(place->reader, &place->path, field, place->given, &value);
    } else if (place->use_default) {
        value = field->default_value;
        known = !isnan(value);
    }
    store(field, place->target, &value, sizeof value);
    if (!known)
        return;
    json_t *effective = field->word != NULL && value == field->word_value
                            ? json_string(field->word)
                            : (field->whole ? json_integer((json_int_t)value) : json_real(value));
    scene_put(place->reader, place->effective, field->key, effective);
}

static void read_boolean(const struct place *place)
{
    const struct scene_field *field = place->field;
    int value = field->default_value == 1.0;
    if (place->given != NULL && !json_is_boolean(place->given)) {
        scene_mistake(place->reader, &place->path, "type", place->given, json_string("boolean"),
                      "expected true or false, not %s", scene_type_word(place->given));
        return;
    }
    if (place->given != NULL)
        value = json_is_true(place->given);
    store_whole(field, place->target, value);
    scene_put(place->reader, place->effective, field->key, json_boolean(value));
}

static void read_choice(const struct place *place)
{
    const struct scene_field *field = place->field;
    int value = isnan(field->default_value) ? -1 : (int)field->default_value;
    if (place->given != NULL)
        value = scene_choice_read(place->reader, &place->path, place->given, field->choices,
                                  field->lacking);
    if (value < 0)
        return;
    store_whole(field, place->target, value);
    scene_put(place->reader, place->effective, field->key, json_string(field->choices[value]));
}

static bool is_name(const char *text)
{
    enum { NAME_MAX_LENGTH = 48 };
    size_t length = strlen(text);
    return length > 0 && length <= NAME_MAX_LENGTH &&
           strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
               length;
}

static void read_text(const struct place *place)
{
    enum { TEXT_MAX_LENGTH = 1000 };
    const struct scene_field *field = place->field;
    const char *text = json_string_value(place->given);
    if (place->given == NULL)
        return;
    if (text == NULL) {
        scene_mistake(place->reader, &place->path, "type", place->given, json_string("string"),
                      "expected a string, not %s", scene_type_word(place->given));
    } else if (field->kind == SCENE_NAME && !is_name(text)) {
        scene_mistake(place->reader, &place->path, "name", place->given, NULL,
                      "a name has 1 to 48 letters, digits, '_' and '-'");
    } else if (scene_character_count(text) > TEXT_MAX_LENGTH) {
        scene_mistake(place->reader, &place->path, "length", NULL, NULL,
                      "a text has at most %d characters", TEXT_MAX_LENGTH);
    } else {
        store(field, place->target, &text, sizeof text);
        scene_put(place->reader, place->effective, field->key, json_string(text));
    }
}

static void read_vector(const struct place *place)
{
    const struct scene_field *field = place->field;
    double value[3] = {0.0, 0.0, 0.0};
    json_t *effective = NULL;
    if (place->given != NULL) {
        if (!scene_vector_read(place->reader, &place->path, field, place->given, value, &effective))
            return;
    } else if (place->use_default && (!isnan(field->default_value) || field->open)) {
        effective = json_array();
        for (size_t k = 0; k < place->reader->axis_count; k++) {
            value[k] = field->default_value;
            if (json_array_append_new(effective,
                                      isfinite(value[k]) ? json_real(value[k]) : json_null()) != 0)
                place->reader->out_of_memory = true;
        }
    } else {
        return;
    }
    store(field, place->target, value, sizeof value);
    scene_put(place->reader, place->effective, field->key, effective);
}

static void read_object(const struct place *place)
{
    const struct scene_field *field = place->field;
    if (place->given == NULL && field->alternative != NULL)
        return;
    json_t *inner = json_object();
    scene_fields_read(place->reader, &place->path, field->fields, place->given, place->target,
                      inner);
    scene_put(place->reader, place->effective, field->key, inner);
}

static void read_custom(const struct place *place)
{
    if (place->given != NULL || place->field->alternative == NULL)
        place->field->read(place->reader, &place->path, place->given, place->target,
                           place->effective);
}

static void read_field(const struct place *place)
{
    static void (*const readers[])(const struct place *) = {
        [SCENE_NUMBER] = read_number, [SCENE_BOOLEAN] = read_boolean, [SCENE_CHOICE] = read_choice,
        [SCENE_TEXT] = read_text,     [SCENE_NAME] = read_text,       [SCENE_VECTOR] = read_vector,
        [SCENE_OBJECT] = read_object, [SCENE_CUSTOM] = read_custom,
    };
    readers[place->field->kind](place);
}

void scene_fields_read(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *table, const json_t *object, void *target,
                       json_t *effective)
{
    if (object != NULL && !json_is_object(object)) {
        scene_mistake(reader, path, "type", object, json_string("object"),
                      "expected an object, not %s", scene_type_word(object));
        return;
    }
    if (object != NULL)
        check_keys(reader, path, table, object);
    struct group_check check = {.reader = reader, .path = path, .object = object};
    scene_groups_visit(table, check_group, &check);
    check_needs(reader, path, table, object);
    for (const struct scene_field *field = table; field->key != NULL; field++) {
        struct place place = {
            .reader = reader,
            .path = {.parent = path, .key = field->key},
            .field = field,
            .given = json_object_get(object, field->key),
            .use_default = !other_is_given(table, field, object),
            .target = target,
            .effective = effective,
        };
        if (field->unsupported)
            continue;
        if (field->required && field->alternative == NULL && place.given == NULL)
            scene_mistake(reader, &place.path, "required", NULL, NULL, "'%s' is required: %s",
                          field->key, field->meaning);
        else
            read_field(&place);
    }
}

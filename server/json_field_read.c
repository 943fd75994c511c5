/* SPDX-License-Identifier: Apache-2.0 */
/* Reads request bodies by their tables. */
#include "json_field.h"

#include "json_pointer.h"
#include "reply.h"
#include "suggest.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { KEYS_MAX = 64 };

void json_keys_check(const json_t *object, const char *parent, const char *const *known,
                     json_t *errors)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    { /* the iterator does not write */
        char pointer[JSON_POINTER_SIZE];
        bool found = false;
        for (size_t index = 0; known[index] != NULL; index++)
            found = found || strcmp(known[index], key) == 0;
        if (found)
            continue;
        const char *near = suggest(key, known);
        json_pointer_join(pointer, parent, key);
        issue_add(errors, pointer, "unknown_key", NULL, NULL, "unknown key%s%s%s",
                  near == NULL ? "" : "; did you mean \"", near == NULL ? "" : near,
                  near == NULL ? "" : "\"?");
    }
}

static void check_keys(const struct json_field *table, const json_t *object, const char *parent,
                       json_t *errors)
{
    const char *known[KEYS_MAX + 1] = {NULL};
    for (size_t index = 0; table[index].key != NULL && index < KEYS_MAX; index++)
        known[index] = table[index].key;
    json_keys_check(object, parent, known, errors);
}

/* Characters, not bytes: what JSON Schema counts. */
static size_t character_count(const json_t *text)
{
    size_t count = 0;
    for (const char *byte = json_string_value(text); byte != NULL && *byte != '\0'; byte++)
        count += ((unsigned char)*byte & 0xc0) != 0x80;
    return count;
}

static void wrong_type(const char *pointer, const json_t *given, const char *wanted, json_t *errors)
{
    issue_add(errors, pointer, "type", given, NULL, "%s is wanted", wanted);
}

static bool number_holds(const struct json_field *field, const char *pointer, const json_t *given,
                         json_t *errors)
{
    const double value = json_number_value(given);
    const bool bounded = json_field_bounded(field);
    if (!json_is_number(given) || (field->kind == FIELD_INTEGER && floor(value) < value)) {
        wrong_type(pointer, given, field->kind == FIELD_INTEGER ? "a whole number" : "a number",
                   errors);
        return false;
    }
    if (field->above_minimum && value <= field->minimum) {
        json_t *above = json_pack("{s:f}", "exclusiveMinimum", field->minimum);
        issue_add(errors, pointer, "range", given, above, "a number above %.15g is wanted",
                  field->minimum);
        json_decref(above);
        return false;
    }
    if (!bounded || (value >= field->minimum && value <= field->maximum))
        return true;
    json_t *allowed = json_pack("{s:f, s:f}", "minimum", field->minimum, "maximum", field->maximum);
    issue_add(errors, pointer, "range", given, allowed, "a number from %.15g to %.15g is wanted",
              field->minimum, field->maximum);
    json_decref(allowed);
    return false;
}

static bool text_holds(const struct json_field *field, const char *pointer, const json_t *given,
                       json_t *errors)
{
    const char *text = json_string_value(given);
    bool listed = field->words == NULL;
    if (text == NULL) {
        wrong_type(pointer, given, "a string", errors);
        return false;
    }
    if (field->most > 0 && character_count(given) > field->most) {
        issue_add(errors, pointer, "length", NULL, NULL,
                  "a string of at most %zu characters is wanted", field->most);
        return false;
    }
    for (size_t index = 0; !listed && field->words[index] != NULL; index++)
        listed = strcmp(field->words[index], text) == 0;
    if (!listed)
        issue_add(errors, pointer, "unknown_value", given, NULL, "unknown word");
    return listed;
}

static bool value_holds(const struct json_field *field, const char *pointer, const json_t *given,
                        json_t *errors);

static bool map_holds(const struct json_field *field, const char *pointer, const json_t *given,
                      json_t *errors)
{
    const char *key;
    json_t *value;
    bool holds = json_is_object(given);
    if (!holds) {
        wrong_type(pointer, given, "an object", errors);
        return false;
    }
    if (field->most > 0 && json_object_size(given) > field->most) {
        issue_add(errors, pointer, "length", NULL, NULL, "at most %zu members are allowed",
                  field->most);
        return false;
    }
    json_object_foreach((json_t *)given, key, value)
    { /* the iterator does not write */
        char place[JSON_POINTER_SIZE];
        json_pointer_join(place, pointer, key);
        if (field->key_holds != NULL && !field->key_holds(key)) {
            issue_add(errors, place, "pattern", NULL, NULL, "the key does not match %s",
                      field->key_pattern);
            holds = false;
        }
        if (!json_is_null(value) || !field->patch)
            holds = value_holds(field->item, place, value, errors) && holds;
    }
    return holds;
}

static bool list_holds(const struct json_field *field, const char *pointer, const json_t *given,
                       json_t *errors)
{
    size_t index;
    json_t *value;
    bool holds = json_is_array(given);
    if (!holds) {
        wrong_type(pointer, given, "an array", errors);
        return false;
    }
    if (field->most > 0 && json_array_size(given) > field->most) {
        issue_add(errors, pointer, "length", NULL, NULL, "at most %zu entries are allowed",
                  field->most);
        return false;
    }
    json_array_foreach(given, index, value)
    {
        char place[JSON_POINTER_SIZE];
        json_pointer_join_index(place, pointer, index);
        holds = value_holds(field->item, place, value, errors) && holds;
    }
    return holds;
}

/* Objects are left to json_fields_read. */
static bool value_holds(const struct json_field *field, const char *pointer, const json_t *given,
                        json_t *errors)
{
    if (json_is_null(given) && field->nullable)
        return true;
    switch (field->kind) {
    case FIELD_TEXT:
        return text_holds(field, pointer, given, errors);
    case FIELD_NUMBER:
    case FIELD_INTEGER:
        return number_holds(field, pointer, given, errors);
    case FIELD_MAP:
        return map_holds(field, pointer, given, errors);
    case FIELD_LIST:
        return list_holds(field, pointer, given, errors);
    case FIELD_OBJECT:
        if (!json_is_object(given))
            wrong_type(pointer, given, "an object", errors);
        return json_is_object(given);
    case FIELD_BOOLEAN:
        if (!json_is_boolean(given))
            wrong_type(pointer, given, "true or false", errors);
        return json_is_boolean(given);
    default:
        return true;
    }
}

/* Puts a value that holds into its place; a missing number or boolean is its preset. */
static bool value_store(const struct json_field *field, const json_t *given, void *target)
{
    void *place = (char *)target + field->offset;
    const bool known = given != NULL && !json_is_null(given);
    switch (field->kind) {
    case FIELD_NUMBER:
        *(double *)place = known ? json_number_value(given) : field->preset;
        return true;
    case FIELD_INTEGER:
        *(int64_t *)place = (int64_t)(known ? json_number_value(given) : field->preset);
        return true;
    case FIELD_BOOLEAN:
        *(bool *)place = known ? json_is_true(given) : field->preset > 0;
        return true;
    case FIELD_TEXT:
    case FIELD_MAP:
    case FIELD_LIST:
        if (!known)
            return true;
        free(*(char **)place);
        *(char **)place = field->kind == FIELD_TEXT ? strdup(json_string_value(given))
                                                    : json_dumps(given, JSON_COMPACT);
        return *(char **)place != NULL;
    default:
        return true;
    }
}

/* `patch`: members may be missing or null, and nothing is stored. */
static void fields_read(const struct json_field *table, const json_t *object, const char *parent,
                        bool patch, void *target, json_t *errors)
{
    check_keys(table, object, parent, errors);
    for (; table->key != NULL; table++) {
        const struct json_field field = json_field_resolve(table);
        const json_t *given = json_object_get(object, field.key);
        char pointer[JSON_POINTER_SIZE];
        json_pointer_join(pointer, parent, field.key);
        const bool none = given == NULL || (patch && json_is_null(given));
        bool holds = none || value_holds(&field, pointer, given, errors);
        /* Of an object that is missing nothing is. */
        if (given == NULL && object != NULL && !field.optional && !patch)
            issue_add(errors, pointer, "required", NULL, NULL, "'%s' is missing", field.key);
        if (field.kind == FIELD_OBJECT && holds)
            fields_read(field.fields, json_is_object(given) ? given : NULL, pointer,
                        patch || field.patch, target, errors);
        else if (field.offset != FIELD_NOWHERE && field.kind != FIELD_OBJECT && !patch &&
                 !field.patch && !value_store(&field, holds ? given : NULL, target))
            issue_add(errors, pointer, "memory", NULL, NULL, "out of memory");
    }
}

void json_fields_read(const struct json_field *table, const json_t *object, const char *parent,
                      void *target, json_t *errors)
{
    fields_read(table, object, parent, false, target, errors);
}

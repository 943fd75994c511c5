/* SPDX-License-Identifier: Apache-2.0 */
/* Tables of fields as JSON Schema (2020-12) and as a description for people and forms. Missing
 * memory shows as NULL at the end: jansson's setters refuse NULL values. */
#include "scene/scene_field.h"

#include <string.h>

static void put(json_t *object, const char *key, json_t *value)
{
    (void)json_object_set_new(object, key, value);
}

static bool has_bounds(const struct scene_field *field)
{
    return field->minimum != 0.0 || field->maximum != 0.0;
}

static void put_bounds(json_t *schema, const struct scene_field *field)
{
    if (has_bounds(field) && isfinite(field->minimum))
        put(schema, field->above_minimum ? "exclusiveMinimum" : "minimum",
            json_real(field->minimum));
    if (has_bounds(field) && isfinite(field->maximum))
        put(schema, field->below_maximum ? "exclusiveMaximum" : "maximum",
            json_real(field->maximum));
}

json_t *scene_number_schema(const struct scene_field *field)
{
    double minimum, maximum;
    json_t *number = json_pack("{s:s}", "type", field->whole ? "integer" : "number");
    scene_bounds_read(field, &minimum, &maximum);
    put(number, field->above_minimum ? "exclusiveMinimum" : "minimum", json_real(minimum));
    put(number, field->below_maximum ? "exclusiveMaximum" : "maximum", json_real(maximum));
    return number;
}

static json_t *number_schema(const struct scene_field *field)
{
    json_t *number = scene_number_schema(field);
    if (field->word == NULL)
        return number;
    return json_pack("{s:[o, {s:s}]}", "oneOf", number, "const", field->word);
}

static json_t *boolean_schema(const struct scene_field *field)
{
    (void)field;
    return json_pack("{s:s}", "type", "boolean");
}

static json_t *choice_schema(const struct scene_field *field)
{
    return json_pack("{s:o}", "enum", scene_word_list(field->choices));
}

static json_t *text_schema(const struct scene_field *field)
{
    if (field->kind == SCENE_NAME)
        return json_pack("{s:s, s:s}", "type", "string", "pattern", "^[A-Za-z0-9_-]{1,48}$");
    return json_pack("{s:s, s:i}", "type", "string", "maxLength", 1000);
}

static json_t *vector_schema(const struct scene_field *field)
{
    json_t *part = number_schema(field);
    if (field->open)
        part = json_pack("{s:[o, {s:s}]}", "oneOf", part, "type", "null");
    json_t *vector = scene_axes_schema(part, 0);
    if (!field->scalar)
        return vector;
    return json_pack("{s:[o, o]}", "oneOf", vector, number_schema(field));
}

static json_t *object_schema(const struct scene_field *field)
{
    return scene_fields_schema(field->fields);
}

static json_t *custom_schema(const struct scene_field *field)
{
    return field->schema();
}

static const struct {
    const char *word; /* for describe */
    json_t *(*schema)(const struct scene_field *field);
} kinds[] = {
    [SCENE_NUMBER] = {"number", number_schema}, [SCENE_BOOLEAN] = {"boolean", boolean_schema},
    [SCENE_CHOICE] = {"choice", choice_schema}, [SCENE_TEXT] = {"text", text_schema},
    [SCENE_NAME] = {"name", text_schema},       [SCENE_VECTOR] = {"vector", vector_schema},
    [SCENE_OBJECT] = {"object", object_schema}, [SCENE_CUSTOM] = {"value", custom_schema},
};

/* The default as JSON, or NULL if there is none worth telling. */
static json_t *default_json(const struct scene_field *field)
{
    double value = field->default_value;
    if (field->required || !isfinite(value))
        return NULL;
    if (field->kind == SCENE_NUMBER && field->word != NULL && value == field->word_value)
        return json_string(field->word);
    if (field->kind == SCENE_NUMBER)
        return json_real(value);
    if (field->kind == SCENE_BOOLEAN)
        return json_boolean(value != 0.0);
    if (field->kind == SCENE_CHOICE)
        return json_string(field->choices[(size_t)value]);
    return NULL;
}

json_t *scene_field_schema(const struct scene_field *field)
{
    json_t *schema = kinds[field->kind].schema(field);
    json_t *preset = default_json(field);
    bool plain = field->unit[0] == '1';
    put(schema, "description",
        json_sprintf("%s%s%s%s", field->meaning != NULL ? field->meaning : "", plain ? "" : " [",
                     plain ? "" : field->unit, plain ? "" : "]"));
    if (preset != NULL)
        put(schema, "default", preset);
    return schema;
}

/* A group of alternatives: exactly one or at most one of its keys. */
static void add_group(const struct scene_field *table, const char *group, bool required,
                      void *context)
{
    json_t *keys = json_array();
    for (const struct scene_field *field = table; field->key != NULL; field++) {
        if (!field->unsupported && scene_field_in_group(field, group))
            (void)json_array_append_new(keys, json_pack("{s:[s]}", "required", field->key));
    }
    if (!required) { /* or none of them */
        json_t *any = json_deep_copy(keys);
        (void)json_array_append_new(keys, json_pack("{s:{s:o}}", "not", "anyOf", any));
    }
    (void)json_array_append_new(context, json_pack("{s:o}", "oneOf", keys));
}

json_t *scene_fields_schema(const struct scene_field *table)
{
    json_t *properties = json_object(), *required = json_array(), *groups = json_array();
    json_t *needs = json_object();
    for (const struct scene_field *field = table; field->key != NULL; field++) {
        if (field->unsupported)
            continue;
        put(properties, field->key, scene_field_schema(field));
        if (field->required && field->alternative == NULL)
            (void)json_array_append_new(required, json_string(field->key));
        if (field->needs != NULL)
            put(needs, field->key, json_pack("[s]", field->needs));
    }
    scene_groups_visit(table, add_group, groups);
    json_t *schema = json_pack("{s:s, s:b, s:o}", "type", "object", "additionalProperties", 0,
                               "properties", properties);
    if (json_array_size(required) > 0)
        put(schema, "required", json_incref(required));
    if (json_array_size(groups) > 0)
        put(schema, "allOf", json_incref(groups));
    if (json_object_size(needs) > 0)
        put(schema, "dependentRequired", json_incref(needs));
    json_decref(required);
    json_decref(groups);
    json_decref(needs);
    return schema;
}

void scene_rule_add(json_t *schema, const char *key, const char *word, const char *const *without,
                    const char *const *with)
{
    json_t *properties = json_object(), *required = json_array();
    for (; *without != NULL; without++)
        put(properties, *without, json_false());
    for (; *with != NULL; with++)
        (void)json_array_append_new(required, json_string(*with));
    if (json_object_get(schema, "allOf") == NULL)
        put(schema, "allOf", json_array());
    (void)json_array_append_new(json_object_get(schema, "allOf"),
                                json_pack("{s:{s:{s:{s:s}}, s:[s]}, s:{s:o, s:o}}", "if",
                                          "properties", key, "const", word, "required", key, "then",
                                          "properties", properties, "required", required));
}

static json_t *field_describe(const struct scene_field *field)
{
    json_t *entry =
        json_pack("{s:s, s:s, s:s, s:b, s:s}", "key", field->key, "type", kinds[field->kind].word,
                  "unit", field->unit, "required", field->required, "meaning",
                  field->meaning != NULL ? field->meaning : "");
    json_t *preset = default_json(field);
    put_bounds(entry, field);
    if (preset != NULL)
        put(entry, "default", preset);
    if (field->alternative != NULL)
        put(entry, "alternative", json_string(field->alternative));
    if (field->kind == SCENE_CHOICE)
        put(entry, "choices", scene_word_list(field->choices));
    if (field->kind == SCENE_OBJECT)
        put(entry, "fields", scene_fields_describe(field->fields));
    return entry;
}

json_t *scene_fields_describe(const struct scene_field *table)
{
    json_t *list = json_array();
    for (const struct scene_field *field = table; field->key != NULL; field++) {
        if (!field->unsupported)
            (void)json_array_append_new(list, field_describe(field));
    }
    return list;
}

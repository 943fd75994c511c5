/* SPDX-License-Identifier: Apache-2.0 */
/* Tables of members as JSON Schema (2020-12), as OpenAPI 3.1 has it. */
#include "json_field.h"
#include "json_text.h"

#include <math.h>

static void put(json_t *object, const char *key, json_t *value)
{
    (void)json_object_set_new(object, key, value);
}

static json_t *words_list(const struct json_field *field)
{
    json_t *list = json_array();
    for (size_t index = 0; field->words[index] != NULL; index++)
        (void)json_array_append_new(list, json_string(field->words[index]));
    if (field->nullable)
        (void)json_array_append_new(list, json_null());
    return list;
}

static void put_text(json_t *schema, const struct json_field *field)
{
    if (field->words != NULL)
        put(schema, "enum", words_list(field));
    if (field->most > 0)
        put(schema, "maxLength", json_integer((json_int_t)field->most));
}

static void put_number(json_t *schema, const struct json_field *field)
{
    const bool bounded = json_field_bounded(field);
    const bool above = bounded || field->above_minimum;
    if (above && isfinite(field->minimum))
        put(schema, field->above_minimum ? "exclusiveMinimum" : "minimum",
            json_number_make(field->minimum));
    if (bounded && isfinite(field->maximum))
        put(schema, "maximum", json_number_make(field->maximum));
    if (isfinite(field->preset) && fabs(field->preset) > 0)
        put(schema, "default", json_number_make(field->preset));
}

static void put_object(json_t *schema, const struct json_field *field, json_t *named)
{
    json_t *properties = json_object(), *required = json_array();
    for (const struct json_field *member = field->fields; member->key != NULL; member++) {
        struct json_field nullable = *member;
        nullable.nullable = member->nullable || field->patch;
        put(properties, member->key, json_field_schema(&nullable, named));
        if (!member->optional && !field->partial && !field->patch)
            (void)json_array_append_new(required, json_string(member->key));
    }
    put(schema, "properties", properties);
    put(schema, "additionalProperties", json_false());
    if (json_array_size(required) > 0)
        put(schema, "required", json_incref(required));
    json_decref(required);
}

static void put_map(json_t *schema, const struct json_field *field, json_t *named)
{
    struct json_field item = *field->item;
    item.nullable = item.nullable || field->patch;
    put(schema, "additionalProperties", json_field_schema(&item, named));
    if (field->key_pattern != NULL)
        put(schema, "propertyNames", json_pack("{s:s}", "pattern", field->key_pattern));
    if (field->most > 0)
        put(schema, "maxProperties", json_integer((json_int_t)field->most));
}

static json_t *type_json(const struct json_field *field)
{
    static const char *const types[] = {
        [FIELD_TEXT] = "string",     [FIELD_NUMBER] = "number", [FIELD_INTEGER] = "integer",
        [FIELD_BOOLEAN] = "boolean", [FIELD_OBJECT] = "object", [FIELD_LIST] = "array",
        [FIELD_MAP] = "object"};
    const char *type = types[field->kind];
    return field->nullable ? json_pack("[s, s]", type, "null") : json_string(type);
}

static json_t *inline_schema(const struct json_field *field, json_t *named)
{
    if (field->kind == FIELD_SCENE)
        return json_pack("{s:s}", "$ref", "#/components/schemas/Scene");
    json_t *schema = json_object();
    if (field->kind != FIELD_ANY)
        put(schema, "type", type_json(field));
    if (field->kind == FIELD_TEXT)
        put_text(schema, field);
    if (field->kind == FIELD_NUMBER || field->kind == FIELD_INTEGER)
        put_number(schema, field);
    if (field->kind == FIELD_OBJECT)
        put_object(schema, field, named);
    if (field->kind == FIELD_MAP)
        put_map(schema, field, named);
    if (field->kind == FIELD_LIST)
        put(schema, "items", json_field_schema(field->item, named));
    if (field->kind == FIELD_LIST && field->most > 0)
        put(schema, "maxItems", json_integer((json_int_t)field->most));
    return schema;
}

bool json_field_bounded(const struct json_field *field)
{
    return field->minimum < 0 || field->minimum > 0 || field->maximum < 0 || field->maximum > 0;
}

struct json_field json_field_resolve(const struct json_field *field)
{
    if (field->kind != FIELD_SAME)
        return *field;
    struct json_field same = *field->item;
    same.key = field->key;
    same.optional = field->optional;
    same.nullable = field->nullable;
    same.patch = field->patch;
    same.offset = field->offset;
    if (field->meaning != NULL)
        same.meaning = field->meaning;
    return same;
}

json_t *json_field_schema(const struct json_field *field, json_t *named)
{
    json_t *schema;
    if (field->kind == FIELD_SAME) {
        const struct json_field same = json_field_resolve(field);
        return json_field_schema(&same, named);
    }
    if (field->schema == NULL) {
        schema = inline_schema(field, named);
    } else {
        struct json_field plain = *field;
        plain.nullable = false;
        if (json_object_get(named, field->schema) == NULL) {
            put(named, field->schema, json_object()); /* ends a circle of references */
            put(named, field->schema, inline_schema(&plain, named));
        }
        schema = json_pack("{s:o}", "$ref", json_sprintf("#/components/schemas/%s", field->schema));
        if (field->nullable)
            schema = json_pack("{s:[o, {s:s}]}", "anyOf", schema, "type", "null");
    }
    if (field->meaning != NULL)
        put(schema, "description", json_string(field->meaning));
    return schema;
}

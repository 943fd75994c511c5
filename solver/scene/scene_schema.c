/* SPDX-License-Identifier: Apache-2.0 */
/* The JSON Schema of a scene. How many components a vector has depends on the dimension: where
 * vectors are made, their schemas are marked, and for every number of axes the root gets a rule
 * that leads to all marked places and says only that. */
#include "scene/scene_sections.h"

#include <string.h>

/* Marks, taken out before the schema is told: entries beyond the number of axes; the type of a
 * value that is a number in a plane and a vector in space. */
static const char axes_mark[] = "x-axes", turn_mark[] = "x-turn";

json_t *scene_axes_schema(json_t *items, int more)
{
    return json_pack("{s:s, s:i, s:i, s:o, s:i}", "type", "array", "minItems", 1 + more, "maxItems",
                     3 + more, "items", items, axes_mark, more);
}

json_t *scene_turn_schema(json_t *schema)
{
    (void)json_object_set_new(schema, turn_mark, json_true());
    return schema;
}

static void put(json_t *object, const char *key, json_t *value)
{
    (void)json_object_set_new(object, key, value);
}

static json_t *axes_rule(const json_t *schema, int axes);

/* The rules of the members of an object of schemas that have any; NULL if none has. */
static json_t *member_rules(const json_t *schemas, int axes)
{
    json_t *rules = json_object(), *schema;
    const char *key;
    json_object_foreach((json_t *)schemas, key, schema)
    { /* the iterator does not write */
        json_t *rule = axes_rule(schema, axes);
        if (rule != NULL)
            put(rules, key, rule);
    }
    if (json_object_size(rules) > 0)
        return rules;
    json_decref(rules);
    return NULL;
}

/* What the number of axes says of a value with this schema; NULL: nothing. Every keyword of a rule
 * speaks of one type of values, so the rules of alternatives of different types are one. */
static json_t *axes_rule(const json_t *schema, int axes)
{
    const json_t *more = json_object_get(schema, axes_mark);
    json_t *rule = json_object(), *alternative;
    json_t *members = member_rules(json_object_get(schema, "properties"), axes);
    const json_t *entry = json_object_get(schema, "items");
    json_t *items = entry == NULL ? NULL : axes_rule(entry, axes);
    size_t index;
    if (json_is_integer(more)) {
        put(rule, "minItems", json_integer(axes + json_integer_value(more)));
        put(rule, "maxItems", json_integer(axes + json_integer_value(more)));
    }
    if (json_object_get(schema, turn_mark) != NULL)
        put(rule, "type", json_string(axes == 3 ? "array" : "number"));
    if (members != NULL)
        put(rule, "properties", members);
    if (items != NULL)
        put(rule, "items", items);
    json_array_foreach(json_object_get(schema, "oneOf"), index, alternative)
    {
        json_t *other = axes_rule(alternative, axes);
        (void)json_object_update_recursive(rule, other);
        json_decref(other);
    }
    if (json_object_size(rule) > 0)
        return rule;
    json_decref(rule);
    return NULL;
}

static void take_marks(json_t *schema)
{
    json_t *value;
    const char *key;
    size_t index;
    (void)json_object_del(schema, axes_mark);
    (void)json_object_del(schema, turn_mark);
    json_object_foreach(schema, key, value)
    {
        take_marks(value);
    }
    json_array_foreach(schema, index, value)
    {
        take_marks(value);
    }
}

/* One rule for each number of axes. */
static void add_rules(json_t *schema)
{
    static const int axes[] = {1, 2, 3};
    json_t *rules = json_array();
    for (size_t index = 0; index < sizeof axes / sizeof axes[0]; index++) {
        json_t *words = scene_dimensions_of((size_t)axes[index]);
        json_t *rule = axes_rule(schema, axes[index]);
        (void)json_array_append_new(rules, json_pack("{s:{s:{s:{s:o}}, s:[s]}, s:o}", "if",
                                                     "properties", "dimension", "enum", words,
                                                     "required", "dimension", "then", rule));
    }
    take_marks(schema);
    put(schema, "allOf", rules);
}

json_t *scene_schema(void)
{
    json_t *schema =
        json_pack("{s:s, s:s, s:s}", "$schema", "https://json-schema.org/draft/2020-12/schema",
                  "title", "Talus scene", "description",
                  "A scene of the Material Point Method. SI units, angles in degrees, "
                  "tension positive.");
    json_t *root = scene_fields_schema(scene_root_fields);
    add_rules(root);
    if (json_object_update_missing(schema, root) != 0) {
        json_decref(schema);
        schema = NULL;
    }
    json_decref(root);
    return schema;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_condition.h"

#include "boundaries/boundary.h"

#include <string.h>

static const double radians_per_degree = 3.14159265358979323846 / 180.0;

static const char *const condition_words[] = {
#define BOUNDARY(symbol) #symbol,
#include "boundaries/boundaries.def"
#undef BOUNDARY
    NULL,
};

const struct scene_field scene_condition_fields[] = {
    SCENE_CONDITION_FIELDS,
    {.key = NULL},
};

void scene_condition_name_read(struct scene_reader *reader, const struct scene_path *path,
                               const json_t *given, void *target, json_t *effective)
{
    struct scene_condition *condition = target;
    int index = scene_choice_read(reader, path, given, condition_words, NULL);
    if (index < 0)
        return;
    condition->index = (size_t)index;
    scene_put(reader, effective, path->key, json_string(condition_words[index]));
}

json_t *scene_condition_name_schema(void)
{
    return json_pack("{s:o}", "enum", scene_word_list(condition_words));
}

static const char *const own_keys[] = {"friction_coefficient", "friction_angle", "adhesion",
                                       "turbulence"};
enum { OWN_KEY_COUNT = sizeof own_keys / sizeof own_keys[0] };

static bool has_parameter(const struct boundary_condition *condition, const char *key)
{
    const struct parameter *parameter = condition->parameters;
    while (parameter->key != NULL && strcmp(parameter->key, key) != 0)
        parameter++;
    return parameter->key != NULL;
}

/* Keys of another condition. */
static void refuse_keys(struct scene_reader *reader, const struct scene_path *path,
                        const json_t *given, size_t index)
{
    for (size_t key = 0; key < OWN_KEY_COUNT; key++) {
        struct scene_path here = {.parent = path, .key = own_keys[key]};
        if (json_object_get(given, own_keys[key]) != NULL &&
            !has_parameter(boundary_table[index], own_keys[key]))
            scene_mistake(reader, &here, "unknown_key", NULL, NULL,
                          "'%s' does not apply to the condition \"%s\"", own_keys[key],
                          condition_words[index]);
    }
}

static double given_or_zero(double value)
{
    return isnan(value) ? 0.0 : value;
}

void scene_condition_finish(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, const struct scene_condition *condition,
                            struct talus_boundary_face *face)
{
    bool angle = json_object_get(given, "friction_angle") != NULL;
    bool present = angle || json_object_get(given, "friction_coefficient") != NULL;
    struct scene_path here = {.parent = path, .key = "friction_coefficient"};
    if (condition->index == SIZE_MAX)
        return;
    refuse_keys(reader, path, given, condition->index);
    if (!present && has_parameter(boundary_table[condition->index], here.key))
        scene_mistake(reader, &here, "required", NULL, NULL,
                      "friction needs 'friction_coefficient' or 'friction_angle'");
    face->condition_index = condition->index;
    face->friction_coefficient = angle ? tan(condition->friction_angle_deg * radians_per_degree)
                                       : given_or_zero(condition->friction_coefficient);
    face->adhesion = given_or_zero(condition->adhesion);
    face->turbulence = given_or_zero(condition->turbulence);
}

void scene_condition_rules_add(json_t *schema)
{
    static const char *const none[] = {NULL};
    for (size_t index = 0; index < boundary_count; index++) {
        const char *without[OWN_KEY_COUNT + 1] = {NULL};
        size_t count = 0;
        for (size_t key = 0; key < OWN_KEY_COUNT; key++) {
            if (!has_parameter(boundary_table[index], own_keys[key]))
                without[count++] = own_keys[key];
        }
        scene_rule_add(schema, "condition", condition_words[index], without, none);
        if (!has_parameter(boundary_table[index], own_keys[0]))
            continue;
        json_t *rules = json_object_get(schema, "allOf");
        json_t *then = json_object_get(json_array_get(rules, json_array_size(rules) - 1), "then");
        (void)json_object_set_new(then, "anyOf",
                                  json_pack("[{s:[s]}, {s:[s]}]", "required",
                                            "friction_coefficient", "required", "friction_angle"));
    }
}

void scene_condition_init(struct scene_condition *condition)
{
    *condition = (struct scene_condition){SIZE_MAX, NAN, NAN, NAN, NAN};
}

const char *scene_condition_name(size_t index)
{
    return condition_words[index];
}

bool scene_condition_eliminates(size_t index)
{
    return boundary_table[index]->eliminates;
}

bool scene_condition_prescribes(size_t index)
{
    return boundary_table[index]->prescribes;
}

json_t *scene_conditions_describe(void)
{
    json_t *list = json_array();
    for (size_t index = 0; index < boundary_count; index++)
        (void)json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "condition",
                                                    boundary_table[index]->name, "summary",
                                                    boundary_table[index]->summary, "reference",
                                                    boundary_table[index]->reference));
    return list;
}

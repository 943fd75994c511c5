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
static const char *const condition_lacking[] = {"velocity", NULL};

const struct scene_field scene_condition_fields[] = {
    SCENE_CONDITION_FIELDS,
    {.key = NULL},
};

void scene_condition_name_read(struct scene_reader *reader, const struct scene_path *path,
                               const json_t *given, void *target, json_t *effective)
{
    struct scene_condition *condition = target;
    int index = scene_choice_read(reader, path, given, condition_words, condition_lacking);
    if (index < 0)
        return;
    condition->index = (size_t)index;
    scene_put(reader, effective, path->key, json_string(condition_words[index]));
}

json_t *scene_condition_name_schema(void)
{
    return json_pack("{s:o}", "enum", scene_word_list(condition_words));
}

static bool has_parameter(const struct boundary_condition *condition, const char *key)
{
    const struct parameter *parameter = condition->parameters;
    while (parameter->key != NULL && strcmp(parameter->key, key) != 0)
        parameter++;
    return parameter->key != NULL;
}

void scene_condition_finish(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, const struct scene_condition *condition,
                            struct talus_boundary_face *face)
{
    bool angle = json_object_get(given, "friction_angle") != NULL;
    const char *key = angle ? "friction_angle" : "friction_coefficient";
    bool present = angle || json_object_get(given, key) != NULL;
    struct scene_path here = {.parent = path, .key = key};
    if (condition->index == SIZE_MAX)
        return;
    bool wanted = has_parameter(boundary_table[condition->index], key);
    if (wanted && !present)
        scene_mistake(reader, &here, "required", NULL, NULL,
                      "friction needs 'friction_coefficient' or 'friction_angle'");
    if (!wanted && present)
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "'%s' does not apply to the condition \"%s\"", key,
                      condition_words[condition->index]);
    face->condition_index = condition->index;
    face->friction_coefficient = 0.0;
    if (angle)
        face->friction_coefficient = tan(condition->friction_angle_deg * radians_per_degree);
    else if (present)
        face->friction_coefficient = condition->friction_coefficient;
}

const char *scene_condition_name(size_t index)
{
    return condition_words[index];
}

bool scene_condition_eliminates(size_t index)
{
    return boundary_table[index]->eliminates;
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

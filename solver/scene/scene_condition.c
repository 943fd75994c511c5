/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_condition.h"

#include <string.h>

static const double radians_per_degree = 3.14159265358979323846 / 180.0;

static const char *const condition_words[] = {"stick", "slip", "friction", "eliminate", NULL};
static const char *const condition_lacking[] = {"velocity", NULL};
enum { CONDITION_FRICTION = 2, CONDITION_ELIMINATE = 3 };

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

void scene_condition_finish(struct scene_reader *reader, const struct scene_path *path,
                            const struct scene_condition *condition,
                            struct talus_boundary_face *face)
{
    bool coefficient = !isnan(condition->friction_coefficient);
    bool angle = !isnan(condition->friction_angle_deg);
    struct scene_path here = {.parent = path,
                              .key = angle ? "friction_angle" : "friction_coefficient"};
    if (condition->index == SIZE_MAX)
        return;
    if (condition->index == CONDITION_FRICTION && !coefficient && !angle)
        scene_mistake(reader, &here, "required", NULL, NULL,
                      "friction needs 'friction_coefficient' or 'friction_angle'");
    if (condition->index != CONDITION_FRICTION && (coefficient || angle))
        scene_mistake(reader, &here, "contradiction", NULL, NULL,
                      "'%s' does not apply to the condition \"%s\"", here.key,
                      condition_words[condition->index]);
    face->condition_index = condition->index;
    face->friction_coefficient =
        coefficient ? condition->friction_coefficient
                    : (angle ? tan(condition->friction_angle_deg * radians_per_degree) : 0.0);
}

bool scene_condition_eliminates(size_t index)
{
    return index == CONDITION_ELIMINATE;
}

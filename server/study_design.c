/* SPDX-License-Identifier: Apache-2.0 */
#include "study_design.h"

#include "json_field.h"
#include "reply.h"
#include "study_reader.h"

#include <string.h>

static const struct {
    const char *name;
    void (*read)(struct study_reader *reader, const json_t *design, const char *pointer);
} kinds[] = {
    [STUDY_GRID] = {"grid", study_read_grid},
    [STUDY_LIST] = {"list", study_read_list},
    [STUDY_SAMPLE] = {"sample", study_read_sample},
    [STUDY_WORK_PRECISION] = {"work_precision", study_read_work_precision},
    [STUDY_BISECT] = {"bisect", study_read_bisect},
};
enum { KIND_COUNT = sizeof kinds / sizeof kinds[0] };

static void kind_read(struct study_reader *reader, const json_t *design)
{
    static const char *const known[] = {"grid", "list", "sample", "work_precision", "bisect", NULL};
    char pointer[JSON_POINTER_SIZE];
    const json_t *chosen = NULL;
    size_t given = 0;
    json_keys_check(design, "/design", known, reader->errors);
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        const json_t *value = json_object_get(design, kinds[kind].name);
        if (value == NULL)
            continue;
        given++;
        chosen = value;
        reader->plan->kind = (enum study_kind)kind;
    }
    const char *name = kinds[reader->plan->kind].name;
    json_pointer_join(pointer, "/design", name);
    if (given != 1)
        issue_add(reader->errors, "/design", given == 0 ? "required" : "contradiction", NULL, NULL,
                  "one of 'grid', 'list', 'sample', 'work_precision' and 'bisect' is wanted");
    else if (!json_is_object(chosen))
        issue_add(reader->errors, pointer, "type", chosen, NULL, "an object is wanted");
    else
        kinds[reader->plan->kind].read(reader, chosen, pointer);
}

bool study_plan_read(const json_t *scene, const json_t *design, size_t rows_max,
                     struct study_plan *plan, json_t *errors)
{
    struct study_reader reader = {
        .scene = scene, .rows_max = rows_max, .plan = plan, .errors = errors};
    size_t before = json_array_size(errors);
    *plan = (struct study_plan){.names = json_array(),
                                .rows = json_array(),
                                .design = json_incref((json_t *)(uintptr_t)design)};
    if (design == NULL)
        issue_add(errors, "/design", "required", NULL, NULL, "'design' is required");
    else if (!json_is_object(design))
        issue_add(errors, "/design", "type", design, NULL, "an object is wanted");
    else
        kind_read(&reader, design);
    if (study_good(&reader, before) && plan->names != NULL && plan->rows != NULL)
        return true;
    if (study_good(&reader, before))
        issue_add(errors, "/design", "memory", NULL, NULL, "out of memory");
    study_plan_release(plan);
    return false;
}

void study_plan_release(struct study_plan *plan)
{
    json_decref(plan->names);
    json_decref(plan->rows);
    json_decref(plan->design);
    memset(plan, 0, sizeof *plan);
}

size_t study_plan_count(const struct study_plan *plan)
{
    size_t each = plan->kind == STUDY_BISECT ? study_bisect_runs_max(&plan->bisect) : 1;
    return each * json_array_size(plan->rows);
}

json_t *study_scene(const json_t *scene, const json_t *set)
{
    const char *pointer;
    json_t *value, *result = json_incref((json_t *)(uintptr_t)scene);
    json_object_foreach((json_t *)(uintptr_t)set, pointer, value)
    {
        json_t *next = json_pointer_put(result, pointer, value);
        json_decref(result);
        result = next;
        if (result == NULL)
            break;
    }
    return result;
}

json_t *study_bisect_row(const struct study_plan *plan, const json_t *repeated, double value)
{
    const char *parameter = plan->bisect.parameter;
    json_t *number = json_real(value);
    json_t *parameters = json_copy(json_object_get(repeated, "parameters"));
    json_t *set = json_copy(json_object_get(repeated, "set"));
    (void)json_object_set(parameters, parameter, number);
    (void)json_object_set_new(set, parameter, number);
    return json_pack("{s:o, s:o}", "parameters", parameters, "set", set);
}

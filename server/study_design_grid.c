/* SPDX-License-Identifier: Apache-2.0 */
/* Designs whose values are written out: every combination, or explicit rows. */
#include "json_field.h"
#include "reply.h"
#include "study_set.h"

#include <stdlib.h>

static bool same_shown(json_t *seen, const json_t *value)
{
    char *text = json_dumps(study_value_shown(value), JSON_ENCODE_ANY | JSON_COMPACT);
    bool same = text != NULL && json_object_get(seen, text) != NULL;
    if (text != NULL)
        (void)json_object_set_new(seen, text, json_true());
    free(text);
    return same;
}

/* The values of one parameter: all good, and no two that a table could not tell apart. */
static void values_check(struct study_reader *reader, const json_t *values, const char *pointer)
{
    json_t *seen = json_object();
    for (size_t index = 0; index < json_array_size(values) && !study_full(reader); index++) {
        char own[JSON_POINTER_SIZE];
        const json_t *value = json_array_get(values, index);
        json_pointer_join_index(own, pointer, index);
        if (study_value_check(reader, value, own) && same_shown(seen, value))
            issue_add(reader->errors, own, "duplicate", study_value_shown(value), NULL,
                      "this value, or a value with this label, was given before");
    }
    json_decref(seen);
}

/* The number of combinations; 0 with issues. */
static double combinations_count(struct study_reader *reader, const json_t *parameters,
                                 const char *pointer)
{
    double count = 1.0;
    size_t before = json_array_size(reader->errors);
    const char *name;
    json_t *values;
    json_object_foreach((json_t *)(uintptr_t)parameters, name, values)
    {
        if (study_full(reader))
            break;
        if (study_array(reader, parameters, name, pointer) != NULL) {
            char own[JSON_POINTER_SIZE];
            json_pointer_join(own, pointer, name);
            values_check(reader, values, own);
            count *= (double)json_array_size(values);
        }
    }
    if (json_object_size(parameters) == 0)
        issue_add(reader->errors, pointer, "range", NULL, NULL, "at least one parameter is wanted");
    return study_good(reader, before) ? count : 0.0;
}

/* Every combination, the last parameter changing fastest. */
static void grid_expand(struct study_reader *reader, struct study_set *set,
                        const json_t *parameters, size_t count)
{
    const json_t *values[STUDY_NAME_MAX];
    json_t *given[STUDY_NAME_MAX];
    size_t names = 0;
    const char *name;
    json_t *list;
    json_object_foreach((json_t *)(uintptr_t)parameters, name, list) values[names++] = list;
    for (size_t row = 0; row < count && !study_full(reader); row++) {
        size_t rest = row;
        for (size_t index = names; index-- > 0;) {
            size_t choices = json_array_size(values[index]);
            given[index] = json_array_get(values[index], rest % choices);
            rest /= choices;
        }
        study_set_row(set, reader, given);
    }
}

void study_read_grid(struct study_reader *reader, const json_t *design, const char *pointer)
{
    static const char *const known[] = {"parameters", "set", NULL};
    char own[JSON_POINTER_SIZE];
    json_keys_check(design, pointer, known, reader->errors);
    const json_t *parameters = study_object(reader, design, "parameters", pointer);
    if (parameters == NULL)
        return;
    json_pointer_join(own, pointer, "parameters");
    double count = combinations_count(reader, parameters, own);
    struct study_set *set = study_set_create(reader, design, pointer, parameters, own);
    if (set != NULL && count > 0.0 && study_rows_fit(reader, count, study_set_size(set), own))
        grid_expand(reader, set, parameters, (size_t)count);
    study_set_destroy(set);
}

static void row_check(struct study_reader *reader, const json_t *row, const json_t *first,
                      const char *pointer)
{
    const char *known[STUDY_NAME_MAX + 1];
    size_t count = 0;
    const char *name;
    json_t *value;
    char own[JSON_POINTER_SIZE];
    if (!json_is_object(row)) {
        issue_add(reader->errors, pointer, "type", row, NULL, "an object is wanted");
        return;
    }
    json_object_foreach((json_t *)(uintptr_t)first, name, value)
    {
        if (count == STUDY_NAME_MAX)
            return; /* told for the first row */
        known[count++] = name;
        json_pointer_join(own, pointer, name);
        value = json_object_get(row, name);
        if (value == NULL)
            issue_add(reader->errors, own, "required", NULL, NULL,
                      "'%s' is required: the first row has it", name);
        else
            (void)study_value_check(reader, value, own);
    }
    known[count] = NULL;
    json_keys_check(row, pointer, known, reader->errors);
}

static void list_expand(struct study_reader *reader, struct study_set *set, const json_t *rows)
{
    const json_t *first = json_array_get(rows, 0);
    for (size_t row = 0; row < json_array_size(rows) && !study_full(reader); row++) {
        json_t *given[STUDY_NAME_MAX];
        size_t count = 0;
        const char *name;
        json_t *value;
        json_object_foreach((json_t *)(uintptr_t)first, name, value) given[count++] =
            json_object_get(json_array_get(rows, row), name);
        study_set_row(set, reader, given);
    }
}

void study_read_list(struct study_reader *reader, const json_t *design, const char *pointer)
{
    static const char *const known[] = {"rows", "set", NULL};
    char place[JSON_POINTER_SIZE], own[JSON_POINTER_SIZE];
    size_t before = json_array_size(reader->errors);
    json_keys_check(design, pointer, known, reader->errors);
    const json_t *rows = study_array(reader, design, "rows", pointer);
    json_pointer_join(place, pointer, "rows");
    if (rows == NULL || !study_rows_fit(reader, (double)json_array_size(rows), 1, place))
        return;
    const json_t *first = json_array_get(rows, 0);
    for (size_t row = 0; row < json_array_size(rows) && !study_full(reader); row++) {
        json_pointer_join_index(own, place, row);
        row_check(reader, json_array_get(rows, row), first, own);
    }
    if (!json_is_object(first))
        return;
    json_pointer_join_index(own, place, 0);
    if (json_object_size(first) == 0)
        issue_add(reader->errors, own, "range", NULL, NULL, "at least one parameter is wanted");
    struct study_set *set = study_set_create(reader, design, pointer, first, own);
    if (set != NULL && study_good(reader, before) &&
        study_rows_fit(reader, (double)json_array_size(rows), study_set_size(set), place))
        list_expand(reader, set, rows);
    study_set_destroy(set);
}

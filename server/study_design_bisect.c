/* SPDX-License-Identifier: Apache-2.0 */
#include "json_field.h"
#include "reply.h"
#include "study_reader.h"

#include <math.h>
#include <string.h>

/* What the search is repeated for: a grid, or one row that sets nothing. */
static void repeated_read(struct study_reader *reader, const json_t *design, const char *pointer)
{
    const json_t *each = json_object_get(design, "for_each");
    char own[JSON_POINTER_SIZE];
    json_pointer_join(own, pointer, "for_each");
    if (json_is_object(each))
        study_read_grid(reader, each, own);
    else if (each != NULL)
        issue_add(reader->errors, own, "type", each, NULL, "an object is wanted");
    else
        (void)json_array_append_new(reader->plan->rows,
                                    json_pack("{s:{}, s:{}}", "parameters", "set"));
}

/* A search cannot vary what its repetitions set. */
static void overlap_check(struct study_reader *reader, const char *pointer)
{
    const char *parameter = reader->plan->bisect.parameter;
    const json_t *first = json_array_get(reader->plan->rows, 0);
    if (json_object_get(json_object_get(first, "set"), parameter) != NULL)
        issue_add(reader->errors, pointer, "contradiction", NULL, NULL,
                  "'for_each' sets %s already", parameter);
}

void study_read_bisect(struct study_reader *reader, const json_t *design, const char *pointer)
{
    static const char *const known[] = {"parameter", "low",      "high", "tolerance",
                                        "condition", "for_each", NULL};
    struct study_bisect *bisect = &reader->plan->bisect;
    struct expression_mistake mistake;
    char own[JSON_POINTER_SIZE];
    json_keys_check(design, pointer, known, reader->errors);
    repeated_read(reader, design, pointer);
    bisect->parameter = study_text(reader, design, "parameter", pointer);
    const char *condition = study_text(reader, design, "condition", pointer);
    bool numbers = study_number(reader, design, "low", pointer, &bisect->low);
    numbers = study_number(reader, design, "high", pointer, &bisect->high) && numbers;
    numbers = study_number(reader, design, "tolerance", pointer, &bisect->tolerance) && numbers;
    json_pointer_join(own, pointer, "parameter");
    if (bisect->parameter != NULL && study_place_check(reader, bisect->parameter, own)) {
        const json_t *present = json_pointer_get(reader->scene, bisect->parameter);
        const char *word = json_string_value(present);
        if (present != NULL && !json_is_number(present) &&
            (word == NULL || strcmp(word, "auto") != 0))
            issue_add(reader->errors, own, "type", present, NULL,
                      "the parameter must be a number of the scene, or a key that is not there");
        overlap_check(reader, own);
    }
    json_pointer_join(own, pointer, "condition");
    if (condition != NULL && !condition_read(condition, &bisect->condition, &mistake))
        issue_add(reader->errors, own, "syntax", json_object_get(design, "condition"), NULL,
                  "at character %zu: %s", mistake.position + 1, mistake.text);
    if (!numbers)
        return;
    json_pointer_join(own, pointer, "high");
    double width = bisect->high - bisect->low;
    double least = 1e-12 * fmax(fabs(bisect->low), fabs(bisect->high));
    if (!(width > 0.0) || !isfinite(width)) {
        issue_add(reader->errors, own, "range", json_object_get(design, "high"), NULL,
                  "'high' must be larger than 'low'");
        return;
    }
    json_pointer_join(own, pointer, "tolerance");
    if (bisect->tolerance <= 0.0 || bisect->tolerance < least)
        issue_add(reader->errors, own, "range", json_object_get(design, "tolerance"), NULL,
                  "'tolerance' must be positive, and not below 1e-12 of the larger end");
    else
        (void)study_rows_fit(reader,
                             (double)study_bisect_runs_max(bisect) *
                                 (double)json_array_size(reader->plan->rows),
                             1 + json_array_size(reader->plan->names), own);
    if (bisect->parameter != NULL)
        (void)json_array_append_new(reader->plan->names, json_string(bisect->parameter));
}

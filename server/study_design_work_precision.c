/* SPDX-License-Identifier: Apache-2.0 */
/* Designs that compare variants of a method at several resolutions. */
#include "json_field.h"
#include "reply.h"
#include "study_reader.h"

#include <string.h>

/* Checks variants or resolutions: labels that differ, and places of the scene. */
static void choices_check(struct study_reader *reader, const json_t *choices, const char *pointer)
{
    static const char *const known[] = {"label", "set", NULL};
    json_t *seen = json_object();
    for (size_t index = 0; index < json_array_size(choices) && !study_full(reader); index++) {
        char own[JSON_POINTER_SIZE], place[JSON_POINTER_SIZE];
        const json_t *choice = json_array_get(choices, index);
        json_pointer_join_index(own, pointer, index);
        if (!json_is_object(choice)) {
            issue_add(reader->errors, own, "type", choice, NULL,
                      "an object with 'label' and 'set' is wanted");
            continue;
        }
        json_keys_check(choice, own, known, reader->errors);
        const char *label = study_text(reader, choice, "label", own);
        const json_t *set = study_object(reader, choice, "set", own);
        json_pointer_join(place, own, "label");
        if (label != NULL && json_object_get(seen, label) != NULL)
            issue_add(reader->errors, place, "duplicate", json_object_get(choice, "label"), NULL,
                      "this label was given before");
        if (label != NULL)
            (void)json_object_set_new(seen, label, json_true());
        json_pointer_join(place, own, "set");
        if (json_object_size(set) > STUDY_SET_MAX / 2)
            issue_add(reader->errors, place, "range", NULL, NULL, "at most %d places are allowed",
                      STUDY_SET_MAX / 2);
    }
    json_decref(seen);
}

struct choice {
    const json_t *object;
    char place[JSON_POINTER_SIZE]; /* of its `set` */
};

static size_t items_add(const struct choice *choice, struct study_item *items, size_t count)
{
    const char *pointer;
    json_t *value;
    json_object_foreach(json_object_get(choice->object, "set"), pointer, value)
    {
        items[count] = (struct study_item){
            .pointer = pointer, .value = value, .place = choice->place, .order = count};
        count++;
    }
    return count;
}

static void row_make(struct study_reader *reader, const struct choice *variant,
                     const struct choice *resolution)
{
    struct study_item items[STUDY_SET_MAX];
    size_t count = items_add(variant, items, 0);
    count = items_add(resolution, items, count);
    study_items_sort(items, count);
    const struct study_item *repeated = study_items_repeated(items, count);
    if (repeated != NULL) {
        char own[JSON_POINTER_SIZE];
        json_pointer_join(own, resolution->place, repeated->pointer);
        issue_add(reader->errors, own, "contradiction", NULL, NULL,
                  "the variant '%s' sets the same place",
                  json_string_value(json_object_get(variant->object, "label")));
        return;
    }
    json_t *parameters =
        json_pack("{s:O, s:O}", "variant", json_object_get(variant->object, "label"), "resolution",
                  json_object_get(resolution->object, "label"));
    study_row_add(reader, parameters, items, count, true);
}

static void choice_find(const json_t *choices, size_t index, const char *pointer,
                        struct choice *choice)
{
    choice->object = json_array_get(choices, index);
    json_pointer_join_index(choice->place, pointer, index);
    json_pointer_join(choice->place, choice->place, "set");
}

/* The largest number of places that any choice sets. */
static size_t places_most(const json_t *choices)
{
    size_t most = 0;
    for (size_t index = 0; index < json_array_size(choices); index++) {
        size_t size = json_object_size(json_object_get(json_array_get(choices, index), "set"));
        most = size > most ? size : most;
    }
    return most;
}

static void rows_make(struct study_reader *reader, const json_t *variants,
                      const char *variant_place, const json_t *resolutions,
                      const char *resolution_place)
{
    struct choice variant, resolution;
    size_t before = json_array_size(reader->errors);
    double rows = (double)json_array_size(variants) * (double)json_array_size(resolutions);
    if (!study_rows_fit(reader, rows, 2 + places_most(variants) + places_most(resolutions),
                        resolution_place))
        return;
    for (size_t row = 0; row < json_array_size(variants) && study_good(reader, before); row++) {
        choice_find(variants, row, variant_place, &variant);
        for (size_t column = 0; column < json_array_size(resolutions) && study_good(reader, before);
             column++) {
            choice_find(resolutions, column, resolution_place, &resolution);
            row_make(reader, &variant, &resolution);
        }
    }
}

static void metrics_read(struct study_reader *reader, const json_t *design, const char *pointer)
{
    static const char *const costs[] = {"wall_seconds", "cpu_seconds", "particle_steps"};
    struct study_plan *plan = reader->plan;
    char own[JSON_POINTER_SIZE];
    plan->error_metric = study_text(reader, design, "error", pointer);
    plan->cost_metric = costs[0];
    const json_t *cost = json_object_get(design, "cost");
    if (cost == NULL)
        return;
    json_t *allowed = json_pack("[s, s, s]", costs[0], costs[1], costs[2]);
    plan->cost_metric = NULL;
    for (size_t index = 0; index < sizeof costs / sizeof costs[0]; index++) {
        if (json_is_string(cost) && strcmp(json_string_value(cost), costs[index]) == 0)
            plan->cost_metric = costs[index];
    }
    json_pointer_join(own, pointer, "cost");
    if (plan->cost_metric == NULL)
        issue_add(reader->errors, own, json_is_string(cost) ? "unknown_value" : "type", cost,
                  allowed, "'wall_seconds', 'cpu_seconds' or 'particle_steps' is wanted");
    json_decref(allowed);
}

void study_read_work_precision(struct study_reader *reader, const json_t *design,
                               const char *pointer)
{
    static const char *const known[] = {"variants", "resolutions", "error", "cost", NULL};
    char first[JSON_POINTER_SIZE], second[JSON_POINTER_SIZE];
    size_t before = json_array_size(reader->errors);
    json_keys_check(design, pointer, known, reader->errors);
    metrics_read(reader, design, pointer);
    const json_t *variants = study_array(reader, design, "variants", pointer);
    const json_t *resolutions = study_array(reader, design, "resolutions", pointer);
    json_pointer_join(first, pointer, "variants");
    json_pointer_join(second, pointer, "resolutions");
    choices_check(reader, variants, first);
    choices_check(reader, resolutions, second);
    (void)json_array_append_new(reader->plan->names, json_string("variant"));
    (void)json_array_append_new(reader->plan->names, json_string("resolution"));
    if (study_good(reader, before))
        rows_make(reader, variants, first, resolutions, second);
}

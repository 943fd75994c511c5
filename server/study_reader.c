/* SPDX-License-Identifier: Apache-2.0 */
#include "study_reader.h"

#include "json_text.h"
#include "reply.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool study_good(const struct study_reader *reader, size_t before)
{
    return json_array_size(reader->errors) == before;
}

bool study_full(const struct study_reader *reader)
{
    return json_array_size(reader->errors) >= PROBLEM_ERROR_MAX;
}

static json_t *member_of(struct study_reader *reader, const json_t *parent, const char *key,
                         const char *pointer, char own[JSON_POINTER_SIZE])
{
    json_t *value = json_object_get(parent, key);
    json_pointer_join(own, pointer, key);
    if (value == NULL)
        issue_add(reader->errors, own, "required", NULL, NULL, "'%s' is required", key);
    return value;
}

json_t *study_object(struct study_reader *reader, const json_t *parent, const char *key,
                     const char *pointer)
{
    char own[JSON_POINTER_SIZE];
    json_t *value = member_of(reader, parent, key, pointer, own);
    if (value == NULL || json_is_object(value))
        return value;
    issue_add(reader->errors, own, "type", value, NULL, "an object is wanted");
    return NULL;
}

json_t *study_array(struct study_reader *reader, const json_t *parent, const char *key,
                    const char *pointer)
{
    char own[JSON_POINTER_SIZE];
    json_t *value = member_of(reader, parent, key, pointer, own);
    if (value == NULL || (json_is_array(value) && json_array_size(value) > 0))
        return value;
    issue_add(reader->errors, own, json_is_array(value) ? "range" : "type", value, NULL,
              "an array of at least one entry is wanted");
    return NULL;
}

bool study_number(struct study_reader *reader, const json_t *parent, const char *key,
                  const char *pointer, double *value)
{
    char own[JSON_POINTER_SIZE];
    const json_t *number = member_of(reader, parent, key, pointer, own);
    *value = json_number_value(number);
    if (number != NULL && !json_is_number(number))
        issue_add(reader->errors, own, "type", number, NULL, "a number is wanted");
    return json_is_number(number);
}

const char *study_text(struct study_reader *reader, const json_t *parent, const char *key,
                       const char *pointer)
{
    char own[JSON_POINTER_SIZE];
    const json_t *text = member_of(reader, parent, key, pointer, own);
    size_t length = json_string_length(text);
    if (json_is_string(text) && length > 0 && length <= STUDY_TEXT_MAX)
        return json_string_value(text);
    if (text != NULL)
        issue_add(reader->errors, own, json_is_string(text) ? "range" : "type", text, NULL,
                  "a text of 1 to %d bytes is wanted", STUDY_TEXT_MAX);
    return NULL;
}

bool study_rows_fit(struct study_reader *reader, double rows, size_t values, const char *pointer)
{
    double cells = rows * (double)(values + 1);
    if (rows <= (double)reader->rows_max && cells <= STUDY_CELL_MAX)
        return true;
    double fitting = fmin((double)reader->rows_max, floor(STUDY_CELL_MAX / (double)(values + 1)));
    json_t *given = json_number_make(fmin(rows, 1e300));
    json_t *allowed = json_pack("{s:I}", "maximum", (json_int_t)fitting);
    issue_add(reader->errors, pointer, "range", given, allowed,
              "the study would have %.15g rows; at most %.15g are allowed", rows, fitting);
    json_decref(given);
    json_decref(allowed);
    return false;
}

bool study_place_check(struct study_reader *reader, const char *pointer, const char *place)
{
    size_t length = 0;
    if (!json_pointer_is_valid(pointer)) {
        issue_add(reader->errors, place, "pointer", NULL, NULL,
                  "a JSON Pointer into the scene is wanted: / before each key (at most %d), ~1 for "
                  "a / and ~0 for a ~ in a key",
                  JSON_POINTER_DEPTH_MAX);
        return false;
    }
    switch (json_pointer_check(reader->scene, pointer, &length)) {
    case JSON_POINTER_FITS:
        return true;
    case JSON_POINTER_INDEX:
        issue_add(reader->errors, place, "pointer", NULL, NULL,
                  "'%.*s' is not an index of the scene's array, nor the next one, nor -",
                  (int)length, pointer);
        return false;
    default:
        issue_add(reader->errors, place, "pointer", NULL, NULL,
                  "the scene has no object or array at '%.*s'; only the last key may be new",
                  (int)length, pointer);
        return false;
    }
}

/* As strings, with / before all other characters: what is within a place follows right behind it.
 */
static int items_compare(const void *left, const void *right)
{
    const struct study_item *a = left, *b = right;
    const char *x = a->pointer, *y = b->pointer;
    while (*x != '\0' && *x == *y) {
        x++;
        y++;
    }
    int first = *x == '/' ? 1 : *x == '\0' ? 0 : (unsigned char)*x + 1;
    int second = *y == '/' ? 1 : *y == '\0' ? 0 : (unsigned char)*y + 1;
    if (first != second)
        return first < second ? -1 : 1;
    return a->order < b->order ? -1 : a->order > b->order;
}

void study_items_sort(struct study_item *items, size_t count)
{
    qsort(items, count, sizeof *items, items_compare);
}

const struct study_item *study_items_repeated(const struct study_item *items, size_t count)
{
    for (size_t index = 1; index < count; index++) {
        if (strcmp(items[index - 1].pointer, items[index].pointer) == 0)
            return &items[index - 1];
    }
    return NULL;
}

bool study_items_nest(const struct study_item *items, size_t count)
{
    for (size_t index = 1; index < count; index++) {
        if (json_pointer_is_within(items[index].pointer, items[index - 1].pointer))
            return true;
    }
    return false;
}

/* Tries the items of a row on the scene, one after the other. */
static void items_try(struct study_reader *reader, const struct study_item *items, size_t count)
{
    const json_t *whole = reader->scene;
    json_t *scene = NULL;
    for (size_t index = 0; index < count; index++) {
        char place[JSON_POINTER_SIZE];
        json_pointer_join(place, items[index].place, items[index].pointer);
        if (!study_place_check(reader, items[index].pointer, place))
            break;
        json_t *next = json_pointer_put(reader->scene, items[index].pointer, items[index].value);
        json_decref(scene);
        reader->scene = scene = next;
        if (next == NULL) {
            issue_add(reader->errors, place, "memory", NULL, NULL, "out of memory");
            break;
        }
    }
    reader->scene = whole;
    json_decref(scene);
}

void study_row_add(struct study_reader *reader, json_t *parameters, const struct study_item *items,
                   size_t count, bool check)
{
    size_t before = json_array_size(reader->errors);
    json_t *set = json_object();
    bool good = parameters != NULL && set != NULL;
    if (check)
        items_try(reader, items, count);
    for (size_t index = 0; good && index < count; index++)
        good = json_object_set(set, items[index].pointer, items[index].value) == 0;
    json_t *row = good ? json_pack("{s:O, s:O}", "parameters", parameters, "set", set) : NULL;
    if (row == NULL)
        issue_add(reader->errors, "/design", "memory", NULL, NULL, "out of memory");
    else if (study_good(reader, before))
        (void)json_array_append(reader->plan->rows, row);
    json_decref(row);
    json_decref(set);
    json_decref(parameters);
}

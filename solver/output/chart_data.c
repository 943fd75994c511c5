/* SPDX-License-Identifier: Apache-2.0 */
#include "output/chart_data.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Beyond these the differences and quotients of numbers are not finite any more. */
#define DRAWABLE_MAX 1e150
#define DRAWABLE_MIN 1e-150

bool chart_is_worded(const struct chart_quantity *quantity)
{
    return quantity->is_parameter && !quantity->words.numeric;
}

static enum talus_status out_of_memory(struct talus_error *error)
{
    return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a chart");
}

static const json_t *parameter_of(const json_t *row, const char *name)
{
    return json_object_get(json_object_get(row, "parameters"), name);
}

/* The text by which a value of a parameter is known: its own, or its number's. */
static const char *value_text(const json_t *value, char number[32])
{
    if (json_is_string(value))
        return json_string_value(value);
    (void)snprintf(number, 32, "%.12g", json_number_value(value));
    return number;
}

static enum talus_status add_word(struct chart_words *words, size_t capacity, const json_t *value,
                                  struct talus_error *error)
{
    char number[32];
    const char *text = value_text(value, number);
    if (json_object_get(words->index, text) != NULL || words->count == capacity)
        return TALUS_OK;
    char *copy = malloc(strlen(text) + 1);
    if (copy == NULL || json_object_set_new_nocheck(words->index, text,
                                                    json_integer((json_int_t)words->count)) != 0) {
        free(copy);
        return out_of_memory(error);
    }
    memcpy(copy, text, strlen(text) + 1);
    words->items[words->count++] = (struct chart_word){
        .text = copy, .number = json_is_number(value) ? json_number_value(value) : NAN};
    words->numeric = words->numeric && json_is_number(value);
    return TALUS_OK;
}

static int compare_words(const void *left, const void *right)
{
    const double a = ((const struct chart_word *)left)->number;
    const double b = ((const struct chart_word *)right)->number;
    return (a > b) - (a < b);
}

/* Finds the values of a parameter, if that is what the name means. */
static enum talus_status find_words(struct chart_quantity *quantity, const json_t *rows,
                                    struct talus_error *error)
{
    struct chart_words *words = &quantity->words;
    enum talus_status status = TALUS_OK;
    words->numeric = true;
    words->index = json_object();
    words->items = calloc(json_array_size(rows) + 1, sizeof *words->items);
    if (words->items == NULL || words->index == NULL)
        return out_of_memory(error);
    for (size_t row = 0; status == TALUS_OK && row < json_array_size(rows); row++) {
        const json_t *value = parameter_of(json_array_get(rows, row), quantity->name);
        quantity->is_parameter = quantity->is_parameter || value != NULL;
        if (json_is_string(value) || json_is_number(value))
            status = add_word(words, json_array_size(rows), value, error);
    }
    if (status != TALUS_OK || !words->numeric)
        return status;
    qsort(words->items, words->count, sizeof *words->items, compare_words);
    for (size_t index = 0; index < words->count; index++) {
        if (json_object_set_new_nocheck(words->index, words->items[index].text,
                                        json_integer((json_int_t)index)) != 0)
            return out_of_memory(error);
    }
    return TALUS_OK;
}

static size_t word_place(const struct chart_words *words, const json_t *value)
{
    char number[32];
    const json_t *place = json_object_get(words->index, value_text(value, number));
    return place == NULL ? SIZE_MAX : (size_t)json_integer_value(place);
}

/* The value of a row for an axis; NAN if there is none. */
static double value_of(const struct chart_quantity *quantity, const json_t *row)
{
    const json_t *value = quantity->is_parameter
                              ? parameter_of(row, quantity->name)
                              : json_object_get(json_object_get(row, "metrics"), quantity->name);
    if (chart_is_worded(quantity) && (json_is_string(value) || json_is_number(value))) {
        size_t place = word_place(&quantity->words, value);
        return place == SIZE_MAX ? NAN : (double)place;
    }
    double number = json_is_number(value) ? json_number_value(value) : NAN;
    return fabs(number) <= DRAWABLE_MAX && (number == 0.0 || fabs(number) >= DRAWABLE_MIN) ? number
                                                                                           : NAN;
}

static bool is_logged(const struct chart_quantity *quantity)
{
    return quantity->logarithmic && !chart_is_worded(quantity);
}

static void read_row(struct chart *chart, const json_t *row, size_t index)
{
    const char *state = json_string_value(json_object_get(row, "state"));
    struct chart_point point = {.row = index};
    if (state == NULL || strcmp(state, "succeeded") != 0) {
        bool ended =
            state != NULL && (strcmp(state, "failed") == 0 || strcmp(state, "cancelled") == 0);
        *(ended ? &chart->failed : &chart->unfinished) += 1;
        return;
    }
    point.x = value_of(&chart->x, row);
    point.y = value_of(&chart->y, row);
    point.z = chart->z.name == NULL ? 0.0 : value_of(&chart->z, row);
    if (chart->series.name != NULL) {
        const json_t *value = parameter_of(row, chart->series.name);
        point.series = json_is_string(value) || json_is_number(value)
                           ? word_place(&chart->series.words, value)
                           : SIZE_MAX;
    }
    if (isnan(point.x + point.y + point.z) || point.series == SIZE_MAX)
        chart->missing++;
    else if ((is_logged(&chart->x) && point.x <= 0.0) || (is_logged(&chart->y) && point.y <= 0.0) ||
             (is_logged(&chart->z) && point.z <= 0.0))
        chart->not_positive++;
    else
        chart->points[chart->count++] = point;
}

static enum talus_status check_row(const json_t *row, size_t index, struct talus_error *error)
{
    const json_t *parameters = json_object_get(row, "parameters");
    const json_t *metrics = json_object_get(row, "metrics");
    char pointer[64];
    (void)snprintf(pointer, sizeof pointer, "/rows/%zu", index);
    if (json_is_object(row) && json_is_object(parameters) &&
        (metrics == NULL || json_is_null(metrics) || json_is_object(metrics)))
        return TALUS_OK;
    return talus_error_set(error, TALUS_INVALID, "type", pointer,
                           "a row has objects 'parameters' and 'metrics' and a text 'state'");
}

/* Contours need numbers on both axes and a number in the third direction. */
static enum talus_status check_contours(const struct chart *chart, struct talus_error *error)
{
    const struct chart_quantity *worded = chart_is_worded(&chart->x)   ? &chart->x
                                          : chart_is_worded(&chart->y) ? &chart->y
                                                                       : NULL;
    if (chart->kind != CHART_CONTOURS)
        return TALUS_OK;
    if (worded != NULL)
        return talus_error_set(error, TALUS_INVALID, "type",
                               worded == &chart->x ? "/chart/x" : "/chart/y",
                               "contours need numbers, and '%.100s' has texts", worded->name);
    if (chart_is_worded(&chart->z))
        return talus_error_set(error, TALUS_INVALID, "type", "/chart/z",
                               "contours are of numbers, and '%.100s' has texts", chart->z.name);
    return TALUS_OK;
}

/* Brings the numbers of a metric to a unit with a prefix, so that they are short. */
static void apply_prefix(struct chart *chart, struct chart_quantity *quantity, size_t offset)
{
    double size = 0.0;
    if (quantity->name == NULL || quantity->unit == NULL || quantity->is_parameter ||
        quantity->logarithmic)
        return;
    for (size_t index = 0; index < chart->count; index++)
        size = fmax(size, fabs(*(double *)((char *)&chart->points[index] + offset)));
    quantity->prefix = render_prefix_find(quantity->unit, size);
    for (size_t index = 0; index < chart->count; index++)
        *(double *)((char *)&chart->points[index] + offset) *= quantity->prefix.factor;
}

enum talus_status chart_read_rows(struct chart *chart, const json_t *rows,
                                  struct talus_error *error)
{
    struct chart_quantity *quantities[] = {&chart->x, &chart->y, &chart->z, &chart->series};
    enum talus_status status = TALUS_OK;
    if (!json_is_array(rows))
        return talus_error_set(error, TALUS_INVALID, rows == NULL ? "required" : "type", "/rows",
                               "an array of rows is wanted");
    chart->row_count = json_array_size(rows);
    chart->points = calloc(chart->row_count + 1, sizeof *chart->points);
    if (chart->points == NULL)
        return out_of_memory(error);
    for (size_t row = 0; status == TALUS_OK && row < chart->row_count; row++)
        status = check_row(json_array_get(rows, row), row, error);
    for (size_t index = 0; status == TALUS_OK && index < 4; index++) {
        if (quantities[index]->name != NULL)
            status = find_words(quantities[index], rows, error);
    }
    if (status == TALUS_OK && chart->series.name != NULL && chart->row_count > 0 &&
        !chart->series.is_parameter)
        status = talus_error_set(error, TALUS_INVALID, "unknown_value", "/chart/series",
                                 "'%.100s' is no parameter of the rows", chart->series.name);
    if (status == TALUS_OK)
        status = check_contours(chart, error);
    for (size_t row = 0; status == TALUS_OK && row < chart->row_count; row++)
        read_row(chart, json_array_get(rows, row), row);
    chart->series_count = chart->series.words.count == 0 ? 1 : chart->series.words.count;
    chart->gridded = chart->x.words.count > 0 && chart->y.words.count > 0 &&
                     2.0 * (double)chart->row_count >= (double)chart->x.words.count *
                                                           (double)chart->y.words.count *
                                                           (double)chart->series_count;
    apply_prefix(chart, &chart->x, offsetof(struct chart_point, x));
    apply_prefix(chart, &chart->y, offsetof(struct chart_point, y));
    apply_prefix(chart, &chart->z, offsetof(struct chart_point, z));
    return status;
}

void chart_release(struct chart *chart)
{
    struct chart_quantity *quantities[] = {&chart->x, &chart->y, &chart->z, &chart->series};
    for (size_t index = 0; index < 4; index++) {
        struct chart_words *words = &quantities[index]->words;
        for (size_t word = 0; word < words->count; word++)
            free(words->items[word].text);
        free(words->items);
        json_decref(words->index);
    }
    free(chart->points);
}

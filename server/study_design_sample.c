/* SPDX-License-Identifier: Apache-2.0 */
/* Designs that fill a box of parameters with points. */
#include "json_field.h"
#include "reply.h"
#include "sampling.h"
#include "study_set.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct sample_range {
    double minimum, maximum;
    bool logarithmic;
};

static const struct {
    const char *name;
    void (*fill)(uint64_t seed, size_t count, size_t dimensions, double *points);
} methods[] = {{"latin_hypercube", sampling_latin_hypercube}, {"sobol", sampling_sobol}};
enum { METHOD_COUNT = sizeof methods / sizeof methods[0] };

/* The index of a word in a NULL-terminated list; an issue and -1 if it is not there. */
static int word_read(struct study_reader *reader, const json_t *given, const char *const *words,
                     const char *pointer)
{
    json_t *allowed = json_array();
    int found = -1;
    for (int index = 0; words[index] != NULL; index++) {
        (void)json_array_append_new(allowed, json_string(words[index]));
        if (json_is_string(given) && strcmp(json_string_value(given), words[index]) == 0)
            found = index;
    }
    if (found < 0)
        issue_add(reader->errors, pointer, json_is_string(given) ? "unknown_value" : "type", given,
                  allowed, "'%s' or '%s' is wanted", words[0], words[1]);
    json_decref(allowed);
    return found;
}

static void range_read(struct study_reader *reader, const json_t *given, const char *pointer,
                       struct sample_range *range)
{
    static const char *const known[] = {"min", "max", "scale", NULL};
    static const char *const scales[] = {"linear", "log", NULL};
    char own[JSON_POINTER_SIZE];
    if (!json_is_object(given)) {
        issue_add(reader->errors, pointer, "type", given, NULL,
                  "an object with 'min' and 'max' is wanted");
        return;
    }
    json_keys_check(given, pointer, known, reader->errors);
    const json_t *scale = json_object_get(given, "scale");
    json_pointer_join(own, pointer, "scale");
    range->logarithmic = scale != NULL && word_read(reader, scale, scales, own) == 1;
    bool minimum = study_number(reader, given, "min", pointer, &range->minimum);
    bool maximum = study_number(reader, given, "max", pointer, &range->maximum);
    json_pointer_join(own, pointer, "max");
    if (minimum && maximum &&
        (!(range->minimum < range->maximum) || !isfinite(range->maximum - range->minimum)))
        issue_add(reader->errors, own, "range", json_object_get(given, "max"), NULL,
                  "'max' must be larger than 'min'");
    json_pointer_join(own, pointer, "min");
    if (minimum && range->logarithmic && range->minimum <= 0.0)
        issue_add(reader->errors, own, "range", json_object_get(given, "min"), NULL,
                  "'min' must be positive on a logarithmic scale");
}

/* The value at a share of a range, with 12 digits: functions of other mathematical libraries differ
 * in the last of 16. */
static double range_value(const struct sample_range *range, double share)
{
    char text[32];
    double value = range->logarithmic ? range->minimum * pow(range->maximum / range->minimum, share)
                                      : range->minimum + share * (range->maximum - range->minimum);
    (void)snprintf(text, sizeof text, "%.12g", value);
    return fmin(fmax(strtod(text, NULL), range->minimum), range->maximum);
}

static void sample_expand(struct study_reader *reader, struct study_set *set,
                          const struct sample_range *ranges, size_t names, const double *points,
                          size_t count)
{
    for (size_t row = 0; row < count && !study_full(reader); row++) {
        json_t *given[STUDY_NAME_MAX];
        for (size_t index = 0; index < names; index++)
            given[index] = json_real(range_value(&ranges[index], points[row * names + index]));
        study_set_row(set, reader, given);
        for (size_t index = 0; index < names; index++)
            json_decref(given[index]);
    }
}

static void sample_draw(struct study_reader *reader, struct study_set *set,
                        const struct sample_range *ranges, int method, uint64_t seed, size_t count)
{
    size_t names = json_array_size(reader->plan->names);
    double *points = malloc((count * names + 1) * sizeof *points);
    if (points == NULL) {
        issue_add(reader->errors, "/design/sample", "memory", NULL, NULL, "out of memory");
        return;
    }
    methods[method].fill(seed, count, names, points);
    sample_expand(reader, set, ranges, names, points, count);
    free(points);
}

static double whole_read(struct study_reader *reader, const json_t *design, const char *key,
                         const char *pointer, double minimum)
{
    char own[JSON_POINTER_SIZE];
    double number;
    json_pointer_join(own, pointer, key);
    if (!study_number(reader, design, key, pointer, &number))
        return minimum;
    if (floor(number) < number || number < minimum || number > 0x1p53) {
        issue_add(reader->errors, own, floor(number) < number ? "type" : "range",
                  json_object_get(design, key), NULL, "a whole number from %.0f is wanted",
                  minimum);
        return minimum;
    }
    return number;
}

void study_read_sample(struct study_reader *reader, const json_t *design, const char *pointer)
{
    static const char *const known[] = {"method", "count", "seed", "parameters", "set", NULL};
    static const char *const words[] = {"latin_hypercube", "sobol", NULL};
    struct sample_range ranges[STUDY_NAME_MAX] = {{.minimum = 0.0}};
    char own[JSON_POINTER_SIZE], count_place[JSON_POINTER_SIZE];
    size_t before = json_array_size(reader->errors), names = 0;
    const char *name;
    json_t *given;
    json_keys_check(design, pointer, known, reader->errors);
    json_pointer_join(own, pointer, "method");
    const json_t *word = json_object_get(design, "method");
    int method = 0;
    if (word == NULL)
        issue_add(reader->errors, own, "required", NULL, NULL, "'method' is required");
    else
        method = word_read(reader, word, words, own);
    double count = whole_read(reader, design, "count", pointer, 1.0), seed = 0.0;
    if (json_object_get(design, "seed") != NULL)
        seed = whole_read(reader, design, "seed", pointer, 0.0);
    json_pointer_join(count_place, pointer, "count");
    const json_t *parameters = study_object(reader, design, "parameters", pointer);
    if (parameters == NULL)
        return;
    json_pointer_join(own, pointer, "parameters");
    if (json_object_size(parameters) == 0)
        issue_add(reader->errors, own, "range", NULL, NULL, "at least one parameter is wanted");
    struct study_set *set = study_set_create(reader, design, pointer, parameters, own);
    json_object_foreach((json_t *)(uintptr_t)parameters, name, given)
    {
        char place[JSON_POINTER_SIZE];
        json_pointer_join(place, own, name);
        if (names < STUDY_NAME_MAX)
            range_read(reader, given, place, &ranges[names++]);
    }
    if (set != NULL && study_good(reader, before) &&
        study_rows_fit(reader, count, study_set_size(set), count_place))
        sample_draw(reader, set, ranges, method, (uint64_t)seed, (size_t)count);
    study_set_destroy(set);
}

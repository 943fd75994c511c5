/* SPDX-License-Identifier: Apache-2.0 */
#include "output/chart_data.h"

#include <math.h>
#include <string.h>

enum { TEXT_BYTES_MAX = 4096 };

static enum talus_status wrong_type(struct talus_error *error, const char *pointer,
                                    const char *wanted)
{
    return talus_error_set(error, TALUS_INVALID, "type", pointer, "%s is wanted", wanted);
}

/* Refuses keys of an object that are not in a NULL-terminated list. */
static enum talus_status check_keys(const json_t *object, const char *pointer,
                                    const char *const *known, struct talus_error *error)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    {
        bool found = false;
        for (size_t index = 0; known[index] != NULL; index++)
            found = found || strcmp(known[index], key) == 0;
        if (!found)
            return talus_error_set(error, TALUS_INVALID, "unknown_key", pointer,
                                   "'%.100s' is not a key of this object", key);
    }
    return TALUS_OK;
}

/* A text at a key, or NULL; `required` refuses a missing one. */
static enum talus_status read_text(const json_t *object, const char *key, const char *pointer,
                                   bool required, const char **text, struct talus_error *error)
{
    const json_t *value = json_object_get(object, key);
    *text = json_string_value(value);
    if (value == NULL && required)
        return talus_error_set(error, TALUS_INVALID, "required", pointer, "'%s' is required", key);
    if (value != NULL && (*text == NULL || json_string_length(value) > TEXT_BYTES_MAX))
        return wrong_type(error, pointer, "a short text");
    return TALUS_OK;
}

static bool set_log(struct chart *chart, const char *axes)
{
    for (const char *axis = axes; *axis != '\0'; axis++) {
        if (*axis == 'x')
            chart->x.logarithmic = true;
        else if (*axis == 'y')
            chart->y.logarithmic = true;
        else if (*axis == 'z' && chart->z.name != NULL)
            chart->z.logarithmic = true;
        else
            return false;
    }
    return *axes != '\0';
}

static enum talus_status read_log(struct chart *chart, const json_t *log, struct talus_error *error)
{
    bool good = true;
    size_t index;
    const json_t *axis;
    if (log == NULL || json_is_false(log))
        return TALUS_OK;
    if (json_is_true(log))
        good = set_log(chart, "xy");
    else if (json_is_string(log))
        good = set_log(chart, json_string_value(log));
    else if (json_is_array(log)) {
        json_array_foreach((json_t *)log, index, axis) good =
            good && json_is_string(axis) && set_log(chart, json_string_value(axis));
    } else
        good = false;
    return good ? TALUS_OK
                : wrong_type(error, "/chart/log", "true, false, \"x\", \"y\", \"xy\" or a list");
}

/* Metrics that every job has, and endings of the names of others. */
static const char *find_unit(const char *name, const json_t *units)
{
    static const char *const known[][2] = {
        {"wall_seconds", "s"},      {"cpu_seconds", "s"},      {"time", "s"},
        {"peak_memory_bytes", "B"}, {"particle_steps", "1"},   {"particle_steps_per_second", "1/s"},
        {"energy_error", "1"},      {"energy_numerical", "1"}, {"momentum_error", "1"},
        {"mass_error", "1"},
    };
    const char *given = json_string_value(json_object_get(units, name));
    const char *end = strrchr(name, '.');
    if (given != NULL)
        return given;
    for (size_t index = 0; index < sizeof known / sizeof known[0]; index++) {
        if (strcmp(name, known[index][0]) == 0)
            return known[index][1];
    }
    if (end != NULL && (strcmp(end, ".time_of_max") == 0 || strcmp(end, ".peak_time") == 0))
        return "s";
    if (strncmp(name, "error.", strlen("error.")) == 0)
        return "1";
    return NULL;
}

static enum talus_status read_chart(struct chart *chart, const json_t *object, const json_t *units,
                                    struct talus_error *error)
{
    static const char *const known[] = {"x", "y", "z", "series", "log", NULL};
    const struct {
        struct chart_quantity *quantity;
        const char *key, *pointer;
        bool required;
    } axes[] = {{&chart->x, "x", "/chart/x", true},
                {&chart->y, "y", "/chart/y", true},
                {&chart->z, "z", "/chart/z", false},
                {&chart->series, "series", "/chart/series", false}};
    if (!json_is_object(object))
        return object == NULL ? talus_error_set(error, TALUS_INVALID, "required", "/chart",
                                                "'chart' is required")
                              : wrong_type(error, "/chart", "an object");
    enum talus_status status = check_keys(object, "/chart", known, error);
    for (size_t index = 0; status == TALUS_OK && index < sizeof axes / sizeof axes[0]; index++) {
        struct chart_quantity *quantity = axes[index].quantity;
        status = read_text(object, axes[index].key, axes[index].pointer, axes[index].required,
                           &quantity->name, error);
        if (status == TALUS_OK && quantity->name != NULL)
            quantity->unit = find_unit(quantity->name, units);
    }
    return status == TALUS_OK ? read_log(chart, json_object_get(object, "log"), error) : status;
}

static enum talus_status read_kind(struct chart *chart, const char *kind, struct talus_error *error)
{
    static const char *const known[] = {"grid", "list", "sample", "work_precision", "bisect"};
    bool found = kind == NULL;
    for (size_t index = 0; !found && index < sizeof known / sizeof known[0]; index++)
        found = strcmp(kind, known[index]) == 0;
    if (!found)
        return talus_error_set(error, TALUS_INVALID, "unknown_value", "/kind",
                               "'%.100s' is no kind of study; there are: grid, list, sample, "
                               "work_precision, bisect",
                               kind);
    chart->joined = kind == NULL || strcmp(kind, "sample") != 0;
    chart->kind = CHART_LINES;
    if (chart->z.name != NULL)
        chart->kind = CHART_CONTOURS;
    else if (kind != NULL && strcmp(kind, "work_precision") == 0)
        chart->kind = CHART_WORK_PRECISION;
    return TALUS_OK;
}

static enum talus_status read_units(const json_t *units, struct talus_error *error)
{
    const char *name;
    json_t *unit;
    if (units != NULL && !json_is_object(units))
        return wrong_type(error, "/units", "an object");
    json_object_foreach((json_t *)units, name, unit)
    {
        if (!json_is_string(unit) || json_string_length(unit) > TEXT_BYTES_MAX)
            return wrong_type(error, "/units", "an object of short texts");
    }
    return TALUS_OK;
}

enum talus_status chart_specify(struct chart *chart, const json_t *specification,
                                struct talus_error *error)
{
    static const char *const known[] = {"op",    "rows",  "chart", "kind",
                                        "title", "units", "width", NULL};
    const json_t *width = json_object_get(specification, "width");
    const json_t *units = json_object_get(specification, "units");
    const char *kind = NULL;
    chart->width = width == NULL ? 1000.0 : json_number_value(width);
    if (!json_is_object(specification))
        return wrong_type(error, "", "an object");
    enum talus_status status = check_keys(specification, "", known, error);
    if (status == TALUS_OK && !(chart->width >= CHART_WIDTH_MIN && chart->width <= CHART_WIDTH_MAX))
        status = talus_error_set(error, TALUS_INVALID, json_is_number(width) ? "range" : "type",
                                 "/width", "a width from %d to %d pixels is wanted",
                                 CHART_WIDTH_MIN, CHART_WIDTH_MAX);
    if (status == TALUS_OK)
        status = read_text(specification, "title", "/title", false, &chart->title, error);
    if (status == TALUS_OK)
        status = read_text(specification, "kind", "/kind", false, &kind, error);
    if (status == TALUS_OK)
        status = read_units(units, error);
    if (status == TALUS_OK)
        status = read_chart(chart, json_object_get(specification, "chart"), units, error);
    if (status == TALUS_OK)
        status = read_kind(chart, kind, error);
    if (width == NULL && chart->kind == CHART_CONTOURS)
        chart->width = 1200.0;
    if (chart->title == NULL)
        chart->title = "";
    return status;
}

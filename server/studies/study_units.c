/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_units.h"

#include "history_reader.h"
#include "jobs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TRIES_MAX = 8, COLUMN_SIZE = 256 };

/* The history that a metric follows from: "probe.runout.final" from "probe.runout", a reaction's
 * "peak" from its force. Times have no entry: everybody knows their unit. */
static bool column_of(const char *metric, char column[COLUMN_SIZE])
{
    const char *end = strrchr(metric, '.');
    const bool peak = end != NULL && strcmp(end, ".peak") == 0;
    if (end == NULL || strcmp(end, ".time_of_max") == 0 || strcmp(end, ".peak_time") == 0)
        return false;
    const int length = snprintf(column, COLUMN_SIZE, "%.*s%s", (int)(end - metric), metric,
                                peak ? ".force.x" : "");
    return length > 0 && length < COLUMN_SIZE;
}

static void units_add(json_t *units, const struct history_reader *history, const json_t *metrics)
{
    const char *metric;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)metrics, metric, value)
    {
        char column[COLUMN_SIZE];
        if (!column_of(metric, column))
            continue;
        const size_t found = history_reader_find(history, column);
        if (found < history->column_count)
            (void)json_object_set_new(units, metric, json_string(history->columns[found].unit));
    }
}

/* Whether a row's job told its units. */
static bool row_read(const struct service *service, const json_t *row, json_t *units)
{
    struct talus_error error = {0};
    struct history_reader history;
    char *folder = jobs_folder(service, json_string_value(json_object_get(row, "job")));
    if (folder == NULL)
        return false;
    const bool good = history_reader_open(&history, folder, &error) == TALUS_OK;
    free(folder);
    if (!good)
        return false;
    units_add(units, &history, json_object_get(row, "metrics"));
    history_reader_close(&history);
    return true;
}

json_t *study_units(const struct service *service, const json_t *rows)
{
    json_t *units = json_object();
    int tries = 0;
    size_t index;
    const json_t *row;
    json_array_foreach((json_t *)(uintptr_t)rows, index, row)
    {
        const char *state = json_string_value(json_object_get(row, "state"));
        if (state == NULL || strcmp(state, "succeeded") != 0 ||
            !json_is_string(json_object_get(row, "job")))
            continue;
        if (row_read(service, row, units) || ++tries == TRIES_MAX)
            break;
    }
    return units;
}

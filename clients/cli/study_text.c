/* SPDX-License-Identifier: Apache-2.0 */
#include "study_text.h"

#include "job_text.h"
#include "subcommand.h"

#include <string.h>

enum { CELL_SIZE = 64 };

static json_int_t count_of(const json_t *study, const char *state)
{
    return json_integer_value(json_object_get(json_object_get(study, "counts"), state));
}

static double number_of(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

void study_format(const json_t *study, char *text, size_t size)
{
    char left[48] = "", more[96] = "", duration[32];
    const json_t *progress = json_object_get(study, "progress");
    const json_t *eta = json_object_get(progress, "eta_seconds");
    const json_int_t failed = count_of(study, "failed"), reused = count_of(study, "reused");
    if (failed > 0 || reused > 0)
        (void)snprintf(more, sizeof more, " (%lld failed, %lld reused)", (long long)failed,
                       (long long)reused);
    if (json_is_number(eta)) {
        duration_format(json_number_value(eta), duration, sizeof duration);
        (void)snprintf(left, sizeof left, ", %s left", duration);
    }
    (void)snprintf(text, size, "%s  %.0f of %.0f rows%s, %lld running%s", json_text(study, "state"),
                   number_of(progress, "rows_ended"), number_of(progress, "rows_expected"), more,
                   (long long)count_of(study, "running"), left);
}

void study_print_line(FILE *stream, const json_t *study)
{
    const json_t *progress = json_object_get(study, "progress");
    (void)fprintf(stream, "%-26s  %-9s  %5.0f/%-5.0f  %-14s  %-20.19s  %s\n",
                  json_text(study, "id"), json_text(study, "state"),
                  number_of(progress, "rows_ended"), number_of(progress, "rows_expected"),
                  json_text(study, "kind"), json_text(study, "created_at"),
                  json_text(study, "name"));
}

void study_print_forecast(FILE *stream, const json_t *study)
{
    const json_t *forecast = json_object_get(study, "forecast");
    const json_t *elapsed = json_object_get(forecast, "elapsed_seconds");
    char expected[32], low[32], high[32], disk[32], memory[32];
    if (!json_is_object(forecast))
        return;
    duration_format(number_of(elapsed, "expected"), expected, sizeof expected);
    duration_format(number_of(elapsed, "low"), low, sizeof low);
    duration_format(number_of(elapsed, "high"), high, sizeof high);
    bytes_format(number_of(forecast, "disk_bytes"), disk, sizeof disk);
    bytes_format(number_of(forecast, "memory_bytes"), memory, sizeof memory);
    (void)fprintf(stream,
                  "forecast    %.0f rows, %.0f of them there already; %s (%s to %s), "
                  "%s disk, %s memory at most a job\n",
                  number_of(forecast, "rows"), number_of(forecast, "reused"), expected, low, high,
                  disk, memory);
}

void study_print_result(FILE *stream, const json_t *study)
{
    const json_t *result = json_object_get(study, "result");
    if (json_text(study, "detail")[0] != '\0')
        (void)fprintf(stream, "detail      %s\n", json_text(study, "detail"));
    if (json_is_object(result))
        (void)fprintf(stream, "result      %.6g (the edge lies in %.6g to %.6g)\n",
                      number_of(result, "value"), number_of(result, "low"),
                      number_of(result, "high"));
}

void study_print(FILE *stream, const json_t *study)
{
    static const char *const states[] = {"waiting",   "queued", "running",
                                         "succeeded", "failed", "cancelled"};
    char line[256];
    study_format(study, line, sizeof line);
    (void)fprintf(stream, "id          %s\nname        %s\ndesign      %s\nstate       %s\n",
                  json_text(study, "id"), json_text(study, "name"), json_text(study, "kind"), line);
    (void)fprintf(stream, "rows       ");
    for (size_t index = 0; index < sizeof states / sizeof states[0]; index++)
        (void)fprintf(stream, " %lld %s%s", (long long)count_of(study, states[index]),
                      states[index], index + 1 < sizeof states / sizeof states[0] ? "," : "\n");
    (void)fprintf(stream, "created     %.19s\n", json_text(study, "created_at"));
    if (json_text(study, "finished_at")[0] != '\0')
        (void)fprintf(stream, "ended       %.19s\n", json_text(study, "finished_at"));
    study_print_forecast(stream, study);
    study_print_result(stream, study);
    job_print_advice(stream, study);
}

static void cell_format(const json_t *value, char cell[CELL_SIZE])
{
    if (json_is_string(value))
        (void)snprintf(cell, CELL_SIZE, "%s", json_string_value(value));
    else if (json_is_number(value))
        (void)snprintf(cell, CELL_SIZE, "%.6g", json_number_value(value));
    else if (json_is_true(value) || json_is_false(value))
        (void)snprintf(cell, CELL_SIZE, "%s", json_is_true(value) ? "true" : "false");
    else
        (void)snprintf(cell, CELL_SIZE, "%s", value == NULL || json_is_null(value) ? "-" : "...");
}

/* The width of a column: of its name and of every value. */
static int column_width(const json_t *rows, const char *group, const char *name)
{
    size_t index, width = strlen(name);
    const json_t *row;
    json_array_foreach(rows, index, row)
    {
        char cell[CELL_SIZE];
        cell_format(json_object_get(json_object_get(row, group), name), cell);
        width = strlen(cell) > width ? strlen(cell) : width;
    }
    return (int)width;
}

/* One row of a group of columns; without a row their names. */
static void columns_print(FILE *stream, const json_t *results, const char *group, const json_t *row)
{
    const json_t *rows = json_object_get(results, "rows");
    size_t index;
    const json_t *name;
    json_array_foreach(json_object_get(results, group), index, name)
    {
        char cell[CELL_SIZE];
        const char *text = json_string_value(name);
        const int width = column_width(rows, group, text);
        if (row != NULL)
            cell_format(json_object_get(json_object_get(row, group), text), cell);
        (void)fprintf(stream, "  %*s", width, row == NULL ? text : cell);
    }
}

void study_print_table(FILE *stream, const json_t *results)
{
    size_t index;
    const json_t *row;
    (void)fprintf(stream, "%6s  %-9s", "row", "state");
    columns_print(stream, results, "parameters", NULL);
    columns_print(stream, results, "metrics", NULL);
    (void)fprintf(stream, "\n");
    json_array_foreach(json_object_get(results, "rows"), index, row)
    {
        (void)fprintf(stream, "%6.0f  %-9s", number_of(row, "row"), json_text(row, "state"));
        columns_print(stream, results, "parameters", row);
        columns_print(stream, results, "metrics", row);
        (void)fprintf(stream, "%s%s\n", json_text(row, "reason")[0] == '\0' ? "" : "  ",
                      json_text(row, "reason"));
    }
}

int study_exit_code(const json_t *study)
{
    return strcmp(json_text(study, "state"), "finished") == 0 ? EXIT_DONE : EXIT_JOB_FAILED;
}

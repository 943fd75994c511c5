/* SPDX-License-Identifier: Apache-2.0 */
#include "output/file.h"
#include "worker/job_run.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A time this much beyond the last row, relative to it, still counts as its time: the last step is
 * rounded to the end of the run. */
static const double time_tolerance = 1e-9;

static bool read_at(const struct history_table *table, size_t column, double time, double *value)
{
    double last = history_value(table, table->row_count - 1, 0);
    if (time > last && time <= last * (1.0 + time_tolerance))
        time = last;
    return history_interpolate(table, column, time, value);
}

/* sqrt(integral (a-b)^2 / integral b^2), trapezoidal over the points of b that a covers. */
struct curve_error {
    double difference, norm; /* integrals so far */
    double last_time, last_difference, last_norm;
    size_t covered;
};

static void add_point(struct curve_error *curve, double time, double value, double reference)
{
    double difference = (value - reference) * (value - reference);
    double norm = reference * reference;
    if (curve->covered > 0) {
        double half = 0.5 * (time - curve->last_time);
        curve->difference += half * (difference + curve->last_difference);
        curve->norm += half * (norm + curve->last_norm);
    }
    curve->last_time = time;
    curve->last_difference = difference;
    curve->last_norm = norm;
    curve->covered++;
}

static double finish_curve(const struct curve_error *curve)
{
    return curve->covered > 1 && curve->norm > 0.0 ? sqrt(curve->difference / curve->norm) : NAN;
}

/* Job ids are file names beside this job's folder and nothing else. */
static bool is_job_id(const char *text)
{
    bool good = *text != '\0';
    for (; *text != '\0'; text++)
        good = good && (isalnum((unsigned char)*text) || *text == '-' || *text == '_');
    return good;
}

static enum talus_status compare_with_job(const struct job_run *run,
                                          const struct history_table *table, size_t column,
                                          const char *job, double *result,
                                          struct talus_error *error)
{
    char beside[FILE_PATH_SIZE], folder[FILE_PATH_SIZE];
    struct history_table other;
    struct curve_error curve = {.covered = 0};
    if (!is_job_id(job))
        return talus_error_set(error, TALUS_INVALID, "reference", "", "'%s' is not a job id", job);
    enum talus_status status = file_path(beside, run->options->folder, "..", error);
    if (status == TALUS_OK)
        status = file_path(folder, beside, job, error);
    if (status == TALUS_OK)
        status = history_table_open(&other, folder, error);
    if (status != TALUS_OK)
        return status;
    size_t other_column = history_find_column(&other, table->columns[column].name);
    if (other_column == other.column_count)
        status = talus_error_set(error, TALUS_INVALID, "reference", "", "job %s has no series %s",
                                 job, table->columns[column].name);
    for (uint64_t row = 0; status == TALUS_OK && row < other.row_count; row++) {
        double time = history_value(&other, row, 0);
        double value = 0.0;
        if (read_at(table, column, time, &value))
            add_point(&curve, time, value, history_value(&other, row, other_column));
    }
    history_table_close(&other);
    *result = finish_curve(&curve);
    return status;
}

static double compare_with_value(const struct history_table *table, size_t column,
                                 const struct talus_reference *reference)
{
    double value = history_value(table, table->row_count - 1, column);
    double expected = reference->value[0];
    if (!isnan(reference->time[0]) && !read_at(table, column, reference->time[0], &value))
        return NAN;
    return fabs(value - expected) / fabs(expected);
}

static double compare_with_curve(const struct history_table *table, size_t column,
                                 const struct talus_reference *reference)
{
    struct curve_error curve = {.covered = 0};
    for (size_t index = 0; index < reference->point_count; index++) {
        double value = 0.0;
        if (read_at(table, column, reference->time[index], &value))
            add_point(&curve, reference->time[index], value, reference->value[index]);
    }
    return finish_curve(&curve);
}

/* The error of one reference; NAN, with the reason in *error, if there is none. */
static double find_error(const struct job_run *run, const struct history_table *table,
                         const struct talus_reference *reference, struct talus_error *error)
{
    char series[192];
    double result = NAN;
    (void)snprintf(series, sizeof series, "probe.%s",
                   run->scene.probes[reference->probe_index].name);
    size_t column = history_find_column(table, series);
    enum talus_status status = TALUS_OK;
    if (column == table->column_count)
        status = talus_error_set(error, TALUS_INVALID, "reference", "",
                                 "%s has more than one component: the reference needs one", series);
    else if (reference->of_job != NULL)
        status = compare_with_job(run, table, column, reference->of_job, &result, error);
    else if (reference->point_count == 1)
        result = compare_with_value(table, column, reference);
    else
        result = compare_with_curve(table, column, reference);
    if (status == TALUS_OK && !isfinite(result))
        (void)talus_error_set(error, TALUS_INVALID, "reference", "",
                              "reference %s: it is 0, or the run does not cover its times",
                              reference->name);
    return status == TALUS_OK ? result : NAN;
}

enum talus_status job_add_reference_errors(struct job_run *run, const struct history_table *table,
                                           json_t *metrics, struct talus_error *error)
{
    enum talus_status status = TALUS_OK;
    if (table->row_count == 0)
        return TALUS_OK;
    for (size_t index = 0; status == TALUS_OK && index < run->scene.reference_count; index++) {
        const struct talus_reference *reference = &run->scene.references[index];
        struct talus_error reason = {.status = TALUS_OK};
        char name[192], pointer[64];
        double result = find_error(run, table, reference, &reason);
        (void)snprintf(name, sizeof name, "error.%s", reference->name);
        if (json_object_set_new(metrics, name, event_number(result)) != 0)
            return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for metrics");
        (void)snprintf(pointer, sizeof pointer, "/references/%zu", index);
        if (reason.status != TALUS_OK)
            status = job_warn(run, reason.code, pointer, reason.text, error);
    }
    return status;
}

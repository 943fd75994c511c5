/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/job_run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { METRIC_NAME_SIZE = 192 };

/* 0 when it was added. */
static int add_metric(json_t *metrics, const char *series, const char *what, double value)
{
    char name[METRIC_NAME_SIZE];
    (void)snprintf(name, sizeof name, "%s%s", series, what);
    return json_object_set_new(metrics, name, event_number(value));
}

struct extremes {
    double minimum, maximum, time_of_maximum;
};

static struct extremes find_extremes(const struct history_table *table, size_t column)
{
    struct extremes extremes = {.minimum = NAN, .maximum = NAN, .time_of_maximum = NAN};
    for (uint64_t row = 0; row < table->row_count; row++) {
        double value = history_value(table, row, column);
        if (!(value >= extremes.minimum))
            extremes.minimum = value;
        if (!(value <= extremes.maximum)) {
            extremes.maximum = value;
            extremes.time_of_maximum = history_value(table, row, 0);
        }
    }
    return extremes;
}

/* Mean over [from, end]. A row holds either a value at its time (trapezoidal rule, linear between
 * rows) or the mean over the interval that ends there (`interval_means`: forces and moments of
 * reactions), which is weighted with the part of the interval behind `from`. */
static double find_mean(const struct history_table *table, size_t column, double from,
                        bool interval_means)
{
    double sum = 0.0, length = 0.0;
    for (uint64_t row = 1; row < table->row_count; row++) {
        double end = history_value(table, row, 0);
        double begin = fmax(history_value(table, row - 1, 0), from);
        double value = history_value(table, row, column);
        double begin_value = value;
        if (!(end > begin))
            continue;
        if (!interval_means && !history_interpolate(table, column, begin, &begin_value))
            continue;
        sum += 0.5 * (begin_value + value) * (end - begin);
        length += end - begin;
    }
    if (length > 0.0)
        return sum / length;
    /* `from` is at or behind the end: the last value. */
    return table->row_count > 0 ? history_value(table, table->row_count - 1, column) : NAN;
}

/* The probe that fills the column "probe.NAME" or "probe.NAME.COMPONENT"; the longest name wins. */
static const struct talus_probe *find_probe(const struct talus_scene *scene, const char *column)
{
    const struct talus_probe *found = NULL;
    size_t found_length = 0;
    const char *name = column + strlen("probe.");
    for (size_t index = 0; index < scene->probe_count; index++) {
        const struct talus_probe *probe = &scene->probes[index];
        size_t length = strlen(probe->name);
        bool matches = strncmp(name, probe->name, length) == 0 &&
                       (name[length] == '\0' || name[length] == '.');
        if (matches && (found == NULL || length > found_length)) {
            found = probe;
            found_length = length;
        }
    }
    return found;
}

static int add_probe(json_t *metrics, const struct job_run *run, const struct history_table *table,
                     size_t column)
{
    const char *name = table->columns[column].name;
    const struct talus_probe *probe = find_probe(&run->scene, name);
    struct extremes extremes = find_extremes(table, column);
    int failed = add_metric(metrics, name, ".final",
                            history_value(table, table->row_count - 1, column)) != 0 ||
                 add_metric(metrics, name, ".min", extremes.minimum) != 0 ||
                 add_metric(metrics, name, ".max", extremes.maximum) != 0 ||
                 add_metric(metrics, name, ".time_of_max", extremes.time_of_maximum) != 0;
    if (probe != NULL && !isnan(probe->mean_from)) {
        bool interval_means =
            probe->kind == TALUS_PROBE_REACTION && probe->quantity != TALUS_REACTION_CONTACT_AREA;
        double mean = find_mean(table, column, probe->mean_from, interval_means);
        failed = add_metric(metrics, name, ".mean", mean) != 0 || failed;
    }
    return failed;
}

static int add_simulation(json_t *metrics, struct job_run *run)
{
    size_t count = 0;
    int failed = 0;
    const struct talus_metric *figures = talus_simulation_metrics(run->simulation, &count);
    for (size_t index = 0; index < count; index++)
        failed = add_metric(metrics, figures[index].name, "", figures[index].value) != 0 || failed;
    return failed;
}

static int add_run(json_t *metrics, const struct job_run *run)
{
    struct talus_simulation_state state;
    struct job_usage usage = job_measure(run);
    const struct job_counters *counters = &run->counters;
    double rate =
        counters->step_seconds > 0.0 ? counters->particle_steps / counters->step_seconds : NAN;
    talus_simulation_get_state(run->simulation, &state);
    return add_metric(metrics, "time", "", state.time) != 0 ||
           add_metric(metrics, "steps", "", (double)state.step) != 0 ||
           add_metric(metrics, "particles", "", (double)state.particle_count) != 0 ||
           add_metric(metrics, "particle_steps", "", counters->particle_steps) != 0 ||
           add_metric(metrics, "particle_steps_per_second", "", rate) != 0 ||
           add_metric(metrics, "wall_seconds", "", usage.wall_seconds) != 0 ||
           add_metric(metrics, "cpu_seconds", "", usage.cpu_seconds) != 0 ||
           add_metric(metrics, "peak_memory_bytes", "", usage.peak_memory_bytes) != 0;
}

json_t *job_metrics(struct job_run *run, const struct history_table *table)
{
    json_t *metrics = json_object();
    int failed = metrics == NULL || add_simulation(metrics, run) != 0 || add_run(metrics, run) != 0;
    for (size_t column = 0; !failed && table->row_count > 0 && column < table->column_count;
         column++) {
        if (strncmp(table->columns[column].name, "probe.", strlen("probe.")) == 0)
            failed = add_probe(metrics, run, table, column);
    }
    if (failed) {
        json_decref(metrics);
        return NULL;
    }
    return metrics;
}

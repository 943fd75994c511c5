/* SPDX-License-Identifier: Apache-2.0 */
#include "job_text.h"

#include "subcommand.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

const char *json_text(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text == NULL ? "" : text;
}

void duration_format(double seconds, char *text, size_t size)
{
    const long whole = lround(fmin(fmax(seconds, 0.0), 1e9));
    if (whole < 60)
        (void)snprintf(text, size, seconds < 10.0 ? "%.1f s" : "%.0f s", seconds);
    else if (whole < 3600)
        (void)snprintf(text, size, "%ld min %ld s", whole / 60, whole % 60);
    else
        (void)snprintf(text, size, "%ld h %ld min", whole / 3600, whole % 3600 / 60);
}

void bytes_format(double bytes, char *text, size_t size)
{
    static const char *const units[] = {"B", "kB", "MB", "GB", "TB"};
    size_t unit = 0;
    while (bytes >= 1000.0 && unit + 1 < sizeof units / sizeof units[0]) {
        bytes /= 1000.0;
        unit++;
    }
    (void)snprintf(text, size, unit == 0 ? "%.0f %s" : "%.1f %s", bytes, units[unit]);
}

/* Appends to text; what does not fit is cut. */
__attribute__((format(printf, 3, 4))) static void append(char *text, size_t size,
                                                         const char *format, ...)
{
    const size_t used = strlen(text);
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text + used, size - used, format, values);
    va_end(values);
}

void progress_format(const json_t *progress, char *text, size_t size)
{
    char left[48];
    const json_t *eta = json_object_get(progress, "eta_seconds");
    const double rate = json_number_value(json_object_get(progress, "particle_steps_per_second"));
    text[0] = '\0';
    append(text, size, "%5.1f %%  t = %.4g s  step %.0f",
           100.0 * json_number_value(json_object_get(progress, "fraction")),
           json_number_value(json_object_get(progress, "time")),
           json_number_value(json_object_get(progress, "step")));
    if (json_is_number(json_object_get(progress, "particles")))
        append(text, size, "  %.0f particles",
               json_number_value(json_object_get(progress, "particles")));
    if (rate > 0.0)
        append(text, size, "  %.2f M particle-steps/s", 1e-6 * rate);
    if (json_is_number(eta)) {
        duration_format(json_number_value(eta), left, sizeof left);
        append(text, size, "  %s left", left);
    }
}

static void print_text(FILE *stream, const char *label, const json_t *object, const char *key)
{
    const char *text = json_text(object, key);
    if (text[0] != '\0')
        (void)fprintf(stream, "%-10s %s\n", label, text);
}

static void print_labels(FILE *stream, json_t *labels)
{
    const char *key;
    json_t *value;
    json_object_foreach(labels, key, value)
    {
        if (json_is_string(value))
            (void)fprintf(stream, "%-10s %s=%s\n", "label", key, json_string_value(value));
    }
}

static double number_of(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

void job_print_forecast(FILE *stream, const json_t *job)
{
    const json_t *forecast = json_object_get(job, "forecast");
    const json_t *seconds = json_object_get(forecast, "wall_seconds");
    char memory[32], disk[32], low[48], high[48];
    if (!json_is_object(forecast))
        return;
    bytes_format(number_of(forecast, "memory_bytes"), memory, sizeof memory);
    bytes_format(number_of(forecast, "disk_bytes"), disk, sizeof disk);
    (void)fprintf(stream, "%-10s %.0f particles, %.0f steps, %s of memory, %s on disk", "forecast",
                  number_of(forecast, "particles"), number_of(forecast, "steps"), memory, disk);
    if (json_is_object(seconds)) {
        duration_format(number_of(seconds, "low"), low, sizeof low);
        duration_format(number_of(seconds, "high"), high, sizeof high);
        (void)fprintf(stream, ", %s to %s", low, high);
    }
    (void)fputc('\n', stream);
}

static void print_items(FILE *stream, const char *label, const json_t *items)
{
    size_t index;
    json_t *item;
    json_array_foreach(items, index, item)
    {
        (void)fprintf(stream, "%-10s %s: %s\n", label, json_text(item, "pointer"),
                      json_text(item, "detail"));
        if (json_text(item, "change")[0] != '\0')
            (void)fprintf(stream, "%-10s   change: %s\n", "", json_text(item, "change"));
    }
}

void job_print_advice(FILE *stream, const json_t *job)
{
    print_items(stream, "warning", json_object_get(job, "warnings"));
    print_items(stream, "advice", json_object_get(job, "advice"));
}

/* Components of peaks, and forces on faces that nothing touched, fill a page. */
static bool is_worth_a_line(const json_t *metrics, const char *key)
{
    char peak[192];
    const char *end = strstr(key, ".peak");
    if (strncmp(key, "reaction.", 9) != 0 || end == NULL)
        return true;
    (void)snprintf(peak, sizeof peak, "%.*s.peak", (int)(end - key), key);
    return end[5] != '.' && json_number_value(json_object_get(metrics, peak)) > 0.0;
}

static void print_metrics(FILE *stream, json_t *metrics)
{
    const char *key;
    json_t *value;
    json_object_foreach(metrics, key, value)
    {
        if (json_is_number(value) && is_worth_a_line(metrics, key))
            (void)fprintf(stream, "  %-44s %.8g\n", key, json_number_value(value));
    }
}

void job_print_result(FILE *stream, const json_t *job)
{
    (void)fprintf(stream, "%-10s %s%s%s\n", "state", json_text(job, "state"),
                  json_text(job, "reason")[0] == '\0' ? "" : ": ", json_text(job, "reason"));
    print_text(stream, "detail", job, "detail");
    if (json_object_size(json_object_get(job, "metrics")) > 0) {
        (void)fprintf(stream, "metrics\n");
        print_metrics(stream, json_object_get(job, "metrics"));
    }
}

void job_print(FILE *stream, const json_t *job)
{
    char text[256];
    const json_t *progress = json_object_get(job, "progress");
    print_text(stream, "id", job, "id");
    print_text(stream, "name", job, "name");
    print_labels(stream, json_object_get(job, "labels"));
    print_text(stream, "created", job, "created_at");
    print_text(stream, "started", job, "started_at");
    print_text(stream, "finished", job, "finished_at");
    (void)fprintf(stream, "%-10s %zu\n", "attempts",
                  json_array_size(json_object_get(job, "attempts")));
    job_print_forecast(stream, job);
    if (json_is_object(progress)) {
        progress_format(progress, text, sizeof text);
        (void)fprintf(stream, "%-10s %s\n", "progress", text);
    }
    job_print_advice(stream, job);
    if (json_is_true(json_object_get(job, "cancel_requested")))
        (void)fprintf(stream, "%-10s requested\n", "cancel");
    job_print_result(stream, job);
}

int job_exit_code(const json_t *job)
{
    return strcmp(json_text(job, "state"), "succeeded") == 0 ? EXIT_DONE : EXIT_JOB_FAILED;
}

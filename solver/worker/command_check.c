/* SPDX-License-Identifier: Apache-2.0 */
/* Validates a scene and prints what it would cost. */
#include "base/protocol.h"
#include "worker/check_answer.h"
#include "worker/command.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct check_options {
    const char *path;
    const char *calibration; /* file, or NULL */
    int threads;
    bool json;
};

static bool parse(int argument_count, char **arguments, struct check_options *options)
{
    for (int index = 1; index < argument_count; index++) {
        if (strcmp(arguments[index], "--json") == 0) {
            options->json = true;
        } else if (strcmp(arguments[index], "--threads") == 0 && index + 1 < argument_count) {
            char *end;
            long threads = strtol(arguments[++index], &end, 10);
            if (*end != '\0' || threads < 1 || threads > 4096)
                return false;
            options->threads = (int)threads;
        } else if (strcmp(arguments[index], "--calibration") == 0 && index + 1 < argument_count) {
            options->calibration = arguments[++index];
        } else if (options->path == NULL && arguments[index][0] != '-') {
            options->path = arguments[index];
        } else {
            return false;
        }
    }
    return options->path != NULL;
}

/* What a daemon has learned of the machine, as it tells its helpers. */
static bool read_calibration(const struct check_options *options, json_t **calibration)
{
    json_error_t mistake;
    if (options->calibration == NULL)
        return true;
    *calibration = json_load_file(options->calibration, JSON_REJECT_DUPLICATES, &mistake);
    if (*calibration == NULL)
        (void)fprintf(stderr, "talus-worker check: %s: %s\n", options->calibration, mistake.text);
    return *calibration != NULL;
}

static const char *text_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text != NULL ? text : "";
}

static double number_of(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

static void print_issues(FILE *stream, const char *prefix, const json_t *issues)
{
    size_t index;
    const json_t *issue;
    json_array_foreach(issues, index, issue)
    {
        const char *pointer = text_of(issue, "pointer");
        (void)fprintf(stream, "%s%s: %s\n", prefix, *pointer != '\0' ? pointer : "scene",
                      text_of(issue, "detail"));
    }
}

static void print_forecast(const json_t *forecast)
{
    const json_t *wall = json_object_get(forecast, "wall_seconds");
    (void)printf("particles          %.0f\n", number_of(forecast, "particles"));
    (void)printf("active cells       %.0f\n", number_of(forecast, "active_cells"));
    (void)printf("critical time step %.4g s\n", number_of(forecast, "critical_time_step"));
    (void)printf("time step          %.4g s\n", number_of(forecast, "time_step"));
    (void)printf("steps              %.0f\n", number_of(forecast, "steps"));
    (void)printf("memory             %.1f MB\n", 1e-6 * number_of(forecast, "memory_bytes"));
    (void)printf("disk               %.1f MB\n", 1e-6 * number_of(forecast, "disk_bytes"));
    (void)printf("wall time          %.3g s (%.3g to %.3g s)\n", number_of(wall, "expected"),
                 number_of(wall, "low"), number_of(wall, "high"));
}

static void print_advice(const json_t *advice)
{
    size_t index;
    const json_t *item;
    json_array_foreach(advice, index, item)
    {
        (void)printf("advice: %s: %s\n        change: %s\n        saves: %s\n",
                     text_of(item, "pointer"), text_of(item, "detail"), text_of(item, "change"),
                     text_of(item, "saves"));
    }
}

int command_check(int argument_count, char **arguments)
{
    struct check_options options = {.path = NULL, .threads = 1, .json = false};
    if (!parse(argument_count, arguments, &options)) {
        (void)fprintf(stderr,
                      "usage: talus-worker check SCENE.json [--threads N] [--calibration FILE] "
                      "[--json]\n");
        return PROTOCOL_EXIT_OTHER;
    }
    json_t *calibration = NULL;
    if (!read_calibration(&options, &calibration))
        return PROTOCOL_EXIT_OTHER;
    json_t *answer = check_answer_file(options.path, options.threads, calibration);
    json_decref(calibration);
    if (answer == NULL) {
        (void)fprintf(stderr, "talus-worker check: out of memory\n");
        return PROTOCOL_EXIT_MEMORY;
    }
    bool valid = json_is_true(json_object_get(answer, "ok"));
    print_issues(stderr, "", json_object_get(answer, "errors"));
    if (options.json) {
        (void)json_dumpf(answer, stdout, JSON_INDENT(2));
        (void)printf("\n");
    } else if (valid) {
        print_forecast(json_object_get(answer, "forecast"));
        print_issues(stdout, "warning: ", json_object_get(answer, "warnings"));
        print_advice(json_object_get(answer, "advice"));
    }
    json_decref(answer);
    if (fflush(stdout) != 0)
        return PROTOCOL_EXIT_OTHER;
    return valid ? PROTOCOL_EXIT_SUCCEEDED : PROTOCOL_EXIT_INVALID;
}

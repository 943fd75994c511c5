/* SPDX-License-Identifier: Apache-2.0 */
#include "job_text.h"
#include "subcommand.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PAGE_MAX = 500, COUNT_MAX = 1000000 };

static const struct option_spec options[] = {
    {"state", "STATE", "only jobs that are queued, running, succeeded, failed or cancelled"},
    {"label", "KEY=VALUE", "only jobs with that label; may be repeated"},
    {"study", "ID", "only jobs of that study"},
    {"text", "TEXT", "only jobs whose name contains that"},
    {"limit", "N", "at most that many jobs (default 50)"},
    {NULL, NULL, NULL},
};

static void print_job(const json_t *job)
{
    char progress[16] = "";
    const json_t *fraction = json_object_get(json_object_get(job, "progress"), "fraction");
    if (json_is_number(fraction))
        (void)snprintf(progress, sizeof progress, "%.1f %%", 100.0 * json_number_value(fraction));
    (void)printf("%-26s  %-9s  %7s  %-20.19s  %s%s%s\n", json_text(job, "id"),
                 json_text(job, "state"), progress, json_text(job, "created_at"),
                 json_text(job, "name"), json_text(job, "reason")[0] == '\0' ? "" : "  ",
                 json_text(job, "reason"));
}

/* Appends "&name=value" with the value escaped; false if it does not fit. */
static bool add_parameter(struct connection *connection, char *path, size_t size, const char *name,
                          const char *value)
{
    const size_t length = strlen(path);
    char *plain = strdup(value);
    char *equals = plain == NULL || strcmp(name, "label") != 0 ? NULL : strchr(plain, '=');
    if (equals != NULL)
        *equals = ':'; /* how the server separates a label's key and value */
    char *escaped = plain == NULL ? NULL : curl_easy_escape(connection->curl, plain, 0);
    const int added =
        escaped == NULL ? -1 : snprintf(path + length, size - length, "&%s=%s", name, escaped);
    curl_free(escaped);
    free(plain);
    return added >= 0 && (size_t)added < size - length;
}

/* "?limit=..&state=.."; NULL when the options are too long or memory ran out. */
static char *make_path(struct connection *connection, const struct arguments *arguments, long limit,
                       const char *cursor)
{
    char path[4096];
    bool good = true;
    (void)snprintf(path, sizeof path, "/v1/jobs?limit=%ld", limit);
    for (size_t index = 0; index < arguments->given_count && good; index++) {
        const char *name = arguments->given[index].name;
        if (strcmp(name, "label") == 0 ||
            ((strcmp(name, "state") == 0 || strcmp(name, "study") == 0 ||
              strcmp(name, "text") == 0) &&
             arguments->given[index].value == arguments_value(arguments, name)))
            good =
                add_parameter(connection, path, sizeof path, name, arguments->given[index].value);
    }
    if (good && cursor != NULL)
        good = add_parameter(connection, path, sizeof path, "cursor", cursor);
    return good ? strdup(path) : NULL;
}

/* Fetches one page into jobs; *cursor is replaced by that of the next page (NULL: none). */
static int fetch_page(struct connection *connection, const struct arguments *arguments, long limit,
                      json_t *jobs, char **cursor)
{
    json_t *page = NULL;
    char *path = make_path(connection, arguments, limit, *cursor);
    free(*cursor);
    *cursor = NULL;
    if (path == NULL) {
        (void)fprintf(stderr, "talus: the options are too long\n");
        return EXIT_USAGE;
    }
    const struct http_request request = {.method = "GET", .path = path};
    const int code = connection_ask(connection, &request, &page);
    const char *next = json_string_value(json_object_get(page, "cursor"));
    if (next != NULL)
        *cursor = strdup(next);
    (void)json_array_extend(jobs, json_object_get(page, "jobs"));
    json_decref(page);
    free(path);
    return code;
}

static void print_jobs(const struct connection *connection, const json_t *jobs)
{
    size_t index;
    json_t *job;
    if (connection->json) {
        (void)json_dumpf(jobs, stdout, JSON_INDENT(2));
        (void)printf("\n");
        return;
    }
    if (json_array_size(jobs) > 0)
        (void)printf("%-26s  %-9s  %7s  %-20s  %s\n", "ID", "STATE", "DONE", "CREATED", "NAME");
    json_array_foreach(jobs, index, job) print_job(job);
}

static int run(struct connection *connection, const struct arguments *arguments)
{
    long wanted;
    int code = EXIT_DONE;
    char *cursor = NULL;
    if (!arguments_integer(arguments, "limit", 1, COUNT_MAX, 50, &wanted))
        return EXIT_USAGE;
    json_t *jobs = json_array();
    do {
        const long left = wanted - (long)json_array_size(jobs);
        code = fetch_page(connection, arguments, left < PAGE_MAX ? left : PAGE_MAX, jobs, &cursor);
    } while (code == EXIT_DONE && cursor != NULL && (long)json_array_size(jobs) < wanted);
    if (code == EXIT_DONE)
        print_jobs(connection, jobs);
    free(cursor);
    json_decref(jobs);
    return code;
}

const struct subcommand subcommand_list = {
    .name = "list",
    .synopsis = "",
    .summary = "lists jobs, newest first",
    .details = "",
    .options = options,
    .operand_min = 0,
    .operand_max = 0,
    .run = run,
};

/* SPDX-License-Identifier: Apache-2.0 */
#include "job_action.h"
#include "job_text.h"
#include "study_text.h"
#include "study_watch.h"
#include "subcommand.h"
#include "submit_request.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const struct option_spec options[] = {
    {"name", "NAME", "submit: another name than the file says"},
    {"check", NULL, "submit: check every row and forecast only; nothing is run"},
    {"watch", NULL, "submit: follow the study to its end, like `talus study watch`"},
    {"idempotency-key", "KEY", "submit: the same key with the same file makes one study"},
    {"state", "STATE", "list: only studies that are running, finished, failed or cancelled"},
    {"limit", "N", "list: at most that many (default 50)"},
    {"csv", NULL, "results: as CSV"},
    {"into", "FILE", "results, chart: write to a file (chart: ID.svg; -: standard output)"},
    {NULL, NULL, NULL},
};

struct action {
    const char *name;
    int operand_min, operand_max; /* behind the action; max < 0: any */
    const char *usage;
    int (*run)(struct connection *connection, const struct arguments *arguments);
};

static const char *operand(const struct arguments *arguments)
{
    return arguments->operands[1];
}

static int print_answer(const struct connection *connection, const struct http_reply *reply,
                        char **id)
{
    json_t *study = json_loadb(reply->body == NULL ? "" : reply->body, reply->length, 0, NULL);
    if (study == NULL) {
        (void)fprintf(stderr, "talus: the answer is not JSON\n");
        return EXIT_REFUSED;
    }
    *id = strdup(json_text(study, "id"));
    if (connection->json) {
        (void)printf("%s", reply->body);
    } else {
        if (json_text(study, "id")[0] != '\0')
            (void)printf("%s %s%s\n", json_text(study, "id"), json_text(study, "state"),
                         reply->replayed ? " (submitted before)" : "");
        study_print_forecast(stdout, study);
        job_print_advice(stdout, study);
    }
    (void)fflush(stdout);
    json_decref(study);
    return EXIT_DONE;
}

static int study_submit(struct connection *connection, const struct arguments *arguments)
{
    struct http_reply reply;
    char *id = NULL;
    const bool check = arguments_has(arguments, "check");
    const char *name = arguments_value(arguments, "name");
    json_t *study = json_file_read(operand(arguments));
    if (study == NULL)
        return EXIT_USAGE;
    if (name != NULL && json_is_object(study))
        (void)json_object_set_new(study, "name", json_string(name));
    char *body = json_dumps(study, JSON_COMPACT);
    json_decref(study);
    if (body == NULL) {
        (void)fprintf(stderr, "talus: the study is no JSON object or array\n");
        return EXIT_USAGE;
    }
    const struct submit_request request = {.path = check ? "/v1/forecast" : "/v1/studies",
                                           .body = body,
                                           .key = arguments_value(arguments, "idempotency-key"),
                                           .makes_nothing = check};
    int code = submit_request_send(connection, &request, &reply);
    if (code == EXIT_DONE)
        code = print_answer(connection, &reply, &id);
    if (code == EXIT_DONE && !check && arguments_has(arguments, "watch"))
        code = id == NULL ? EXIT_USAGE : study_watch(connection, id);
    http_reply_release(&reply);
    free(body);
    free(id);
    return code;
}

static int study_list(struct connection *connection, const struct arguments *arguments)
{
    char path[256];
    long limit;
    size_t index;
    json_t *page = NULL, *study;
    const char *state = arguments_value(arguments, "state");
    if (!arguments_integer(arguments, "limit", 1, 500, 50, &limit))
        return EXIT_USAGE;
    char *escaped = state == NULL ? NULL : curl_easy_escape(connection->curl, state, 0);
    (void)snprintf(path, sizeof path, "/v1/studies?limit=%ld%s%.100s", limit,
                   escaped == NULL ? "" : "&state=", escaped == NULL ? "" : escaped);
    curl_free(escaped);
    const struct http_request request = {.method = "GET", .path = path};
    int code = connection_ask(connection, &request, &page);
    const json_t *studies = json_object_get(page, "studies");
    if (code == EXIT_DONE && connection->json) {
        (void)json_dumpf(studies, stdout, JSON_COMPACT);
        (void)printf("\n");
    }
    json_array_foreach(studies, index, study)
    {
        if (!connection->json)
            study_print_line(stdout, study);
    }
    json_decref(page);
    return code;
}

static int study_show(struct connection *connection, const struct arguments *arguments)
{
    json_t *study = NULL;
    char *path = resource_path("studies", operand(arguments), "", NULL);
    if (path == NULL)
        return EXIT_USAGE;
    const struct http_request request = {.method = "GET", .path = path};
    int code = connection_ask(connection, &request, &study);
    if (code == EXIT_DONE && connection->json) {
        (void)json_dumpf(study, stdout, JSON_COMPACT);
        (void)printf("\n");
    } else if (code == EXIT_DONE) {
        study_print(stdout, study);
    }
    json_decref(study);
    free(path);
    return code;
}

static int study_follow(struct connection *connection, const struct arguments *arguments)
{
    return study_watch(connection, operand(arguments));
}

/* Opens where the output goes; "-" and NULL are the standard output. */
static FILE *output_open(const char *path)
{
    FILE *stream = path == NULL || strcmp(path, "-") == 0 ? stdout : fopen(path, "wb");
    if (stream == NULL)
        (void)fprintf(stderr, "talus: cannot write %s: %s\n", path, strerror(errno));
    return stream;
}

static int output_close(FILE *stream, const char *path)
{
    const bool failed = ferror(stream) != 0;
    if ((stream == stdout ? fflush(stream) : fclose(stream)) == 0 && !failed)
        return EXIT_DONE;
    (void)fprintf(stderr, "talus: cannot write %s\n", path == NULL ? "the output" : path);
    return EXIT_USAGE;
}

static bool write_bytes(void *context, const char *data, size_t length)
{
    return fwrite(data, 1, length, context) == length;
}

/* Fetches a document of a study as it is into a file. */
static int document_fetch(struct connection *connection, const char *id, const char *suffix,
                          const char *accept, const char *file)
{
    char *path = resource_path("studies", id, suffix, NULL);
    FILE *stream = path == NULL ? NULL : output_open(file);
    if (stream == NULL) {
        free(path);
        return EXIT_USAGE;
    }
    const struct http_request request = {.method = "GET",
                                         .path = path,
                                         .headers = {accept},
                                         .receive = write_bytes,
                                         .context = stream};
    const int code = connection_ask(connection, &request, NULL);
    const int closed = output_close(stream, file);
    if (code != EXIT_DONE && stream != stdout)
        (void)remove(file);
    free(path);
    return code == EXIT_DONE ? closed : code;
}

static int table_print(struct connection *connection, const char *id, const char *file)
{
    json_t *results = NULL;
    char *path = resource_path("studies", id, "/results", NULL);
    if (path == NULL)
        return EXIT_USAGE;
    const struct http_request request = {.method = "GET", .path = path};
    int code = connection_ask(connection, &request, &results);
    FILE *stream = code == EXIT_DONE ? output_open(file) : NULL;
    if (stream != NULL) {
        study_print_table(stream, results);
        code = output_close(stream, file);
    } else if (code == EXIT_DONE) {
        code = EXIT_USAGE;
    }
    json_decref(results);
    free(path);
    return code;
}

static int study_results(struct connection *connection, const struct arguments *arguments)
{
    const char *file = arguments_value(arguments, "into");
    if (arguments_has(arguments, "csv"))
        return document_fetch(connection, operand(arguments), "/results", "Accept: text/csv", file);
    if (connection->json)
        return document_fetch(connection, operand(arguments), "/results",
                              "Accept: application/json", file);
    return table_print(connection, operand(arguments), file);
}

static int study_chart(struct connection *connection, const struct arguments *arguments)
{
    char name[128];
    const char *file = arguments_value(arguments, "into");
    (void)snprintf(name, sizeof name, "%.100s.svg", operand(arguments));
    const char *target = file == NULL ? name : file;
    int code = document_fetch(connection, operand(arguments), "/chart.svg", "Accept: image/svg+xml",
                              target);
    if (code == EXIT_DONE && strcmp(target, "-") != 0 && !connection->json)
        (void)printf("%s\n", target);
    return code;
}

static int study_cancel(struct connection *connection, const struct arguments *arguments)
{
    return resource_action_run(connection, "studies", arguments->operands + 1,
                               arguments->operand_count - 1, "POST", "/cancel");
}

static int study_delete(struct connection *connection, const struct arguments *arguments)
{
    return resource_action_run(connection, "studies", arguments->operands + 1,
                               arguments->operand_count - 1, "DELETE", "");
}

static const struct action actions[] = {
    {"submit", 1, 1, "submit STUDY.json", study_submit},
    {"list", 0, 0, "list", study_list},
    {"show", 1, 1, "show ID", study_show},
    {"watch", 1, 1, "watch ID", study_follow},
    {"results", 1, 1, "results ID", study_results},
    {"chart", 1, 1, "chart ID", study_chart},
    {"cancel", 1, -1, "cancel ID...", study_cancel},
    {"delete", 1, -1, "delete ID...", study_delete},
};

static int run(struct connection *connection, const struct arguments *arguments)
{
    const int count = arguments->operand_count - 1;
    for (size_t index = 0; index < sizeof actions / sizeof actions[0]; index++) {
        const struct action *action = &actions[index];
        if (strcmp(action->name, arguments->operands[0]) != 0)
            continue;
        if (count >= action->operand_min &&
            (action->operand_max < 0 || count <= action->operand_max))
            return action->run(connection, arguments);
        (void)fprintf(stderr, "usage: talus study [OPTIONS] %s\n", action->usage);
        return EXIT_USAGE;
    }
    (void)fprintf(stderr, "talus: unknown action '%s' (talus study --help)\n",
                  arguments->operands[0]);
    return EXIT_USAGE;
}

const struct subcommand subcommand_study = {
    .name = "study",
    .synopsis = "ACTION [ARGUMENT...]",
    .summary = "studies: sets of jobs from one scene",
    .details =
        "submit STUDY.json  checks every row and submits the study (- reads standard input)\n"
        "list               studies, newest first\n"
        "show ID            how far a study is\n"
        "watch ID           follows it to its end; exit code 0 if it finished\n"
        "results ID         a row for each job: parameters, state, metrics\n"
        "chart ID           the chart that the study asks for, as SVG\n"
        "cancel ID...       stops what waits and runs, and keeps the results\n"
        "delete ID...       removes studies that have ended, with their own jobs\n",
    .options = options,
    .operand_min = 1,
    .operand_max = -1,
    .run = run,
};

/* SPDX-License-Identifier: Apache-2.0 */
#include "job_text.h"
#include "subcommand.h"
#include "submit_request.h"
#include "watch.h"

#include <stdlib.h>
#include <string.h>

static const struct option_spec options[] = {
    {"name", "NAME", "a name for people"},
    {"label", "KEY=VALUE", "a label to find the job by; may be repeated"},
    {"priority", "N", "-100 to 100; larger ones start first (default 0)"},
    {"threads", "N", "threads of the job; 0: as many as pay (default 1)"},
    {"wall-seconds", "S", "end the job after that time over all attempts"},
    {"idempotency-key", "KEY", "the same key with the same scene makes one job (default: random)"},
    {"check", NULL, "validate and forecast only; nothing is run"},
    {"watch", NULL, "follow the job to its end, like `talus watch`"},
    {NULL, NULL, NULL},
};

static bool add_labels(json_t *body, const struct arguments *arguments)
{
    json_t *labels = json_object();
    for (size_t index = 0; index < arguments->given_count; index++) {
        const char *pair = arguments->given[index].value;
        const char *equals = strchr(pair, '=');
        if (strcmp(arguments->given[index].name, "label") != 0)
            continue;
        char *key = equals == NULL ? NULL : strndup(pair, (size_t)(equals - pair));
        if (key == NULL || key[0] == '\0') {
            (void)fprintf(stderr, "talus: --label takes KEY=VALUE\n");
            free(key);
            json_decref(labels);
            return false;
        }
        (void)json_object_set_new(labels, key, json_string(equals + 1));
        free(key);
    }
    if (json_object_size(labels) > 0)
        (void)json_object_set(body, "labels", labels);
    json_decref(labels);
    return true;
}

static bool add_numbers(json_t *body, const struct arguments *arguments)
{
    long priority, threads, seconds;
    if (!arguments_integer(arguments, "priority", -100, 100, 0, &priority) ||
        !arguments_integer(arguments, "threads", 0, 4096, 1, &threads) ||
        !arguments_integer(arguments, "wall-seconds", 1, 1000000000, 1, &seconds))
        return false;
    if (arguments_has(arguments, "priority"))
        (void)json_object_set_new(body, "priority", json_integer(priority));
    if (arguments_has(arguments, "threads"))
        (void)json_object_set_new(body, "threads", json_integer(threads));
    if (arguments_has(arguments, "wall-seconds"))
        (void)json_object_set_new(body, "limits",
                                  json_pack("{s:I}", "wall_seconds", (json_int_t)seconds));
    return true;
}

/* The body of the request as text; NULL with a message. */
static char *make_body(const struct arguments *arguments)
{
    json_t *scene = json_file_read(arguments->operands[0]);
    if (scene == NULL)
        return NULL;
    char *text = NULL;
    const char *name = arguments_value(arguments, "name");
    json_t *body = json_pack("{s:o}", "scene", scene);
    if (name != NULL)
        (void)json_object_set_new(body, "name", json_string(name));
    if (add_labels(body, arguments) && add_numbers(body, arguments)) {
        text = json_dumps(body, JSON_COMPACT);
        if (text == NULL)
            (void)fprintf(stderr, "talus: the scene or an option is not UTF-8\n");
    }
    json_decref(body);
    return text;
}

static void print_submitted(const struct http_reply *reply, const json_t *job)
{
    (void)printf("%s %s%s\n", json_text(job, "id"), json_text(job, "state"),
                 reply->replayed ? " (submitted before)" : "");
    job_print_forecast(stdout, job);
    job_print_advice(stdout, job);
    (void)fflush(stdout);
}

/* The answer to a submission or a forecast. *id is set (free it) when a job was made. */
static int take_answer(const struct connection *connection, const struct http_reply *reply,
                       char **id)
{
    json_t *job = json_loadb(reply->body == NULL ? "" : reply->body, reply->length, 0, NULL);
    if (job == NULL) {
        (void)fprintf(stderr, "talus: the answer is not JSON\n");
        return EXIT_REFUSED;
    }
    if (connection->json)
        (void)printf("%s\n", reply->body);
    else if (json_text(job, "id")[0] != '\0')
        print_submitted(reply, job);
    else {
        job_print_forecast(stdout, job);
        job_print_advice(stdout, job);
    }
    (void)fflush(stdout);
    *id = strdup(json_text(job, "id"));
    json_decref(job);
    return EXIT_DONE;
}

static int send_body(struct connection *connection, const struct arguments *arguments,
                     const char *body, char **id)
{
    struct http_reply reply;
    const bool check = arguments_has(arguments, "check");
    const struct submit_request request = {.path = check ? "/v1/forecast" : "/v1/jobs",
                                           .body = body,
                                           .key = arguments_value(arguments, "idempotency-key"),
                                           .makes_nothing = check};
    int code = submit_request_send(connection, &request, &reply);
    if (code == EXIT_DONE)
        code = take_answer(connection, &reply, id);
    http_reply_release(&reply);
    return code;
}

static int run(struct connection *connection, const struct arguments *arguments)
{
    char *id = NULL;
    char *body = make_body(arguments);
    if (body == NULL)
        return EXIT_USAGE;
    int code = send_body(connection, arguments, body, &id);
    if (code == EXIT_DONE && arguments_has(arguments, "watch") &&
        !arguments_has(arguments, "check"))
        code = id == NULL ? EXIT_USAGE : watch_job(connection, id, NULL);
    free(id);
    free(body);
    return code;
}

const struct subcommand subcommand_submit = {
    .name = "submit",
    .synopsis = "SCENE.json",
    .summary = "submits a scene (- reads it from standard input)",
    .details = "When it returns, the job is on the server's disk.\n",
    .options = options,
    .operand_min = 1,
    .operand_max = 1,
    .run = run,
};

/* SPDX-License-Identifier: Apache-2.0 */
#include "job_text.h"
#include "problem_text.h"
#include "subcommand.h"
#include "watch.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

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

/* The scene of a file ("-": standard input); NULL, with a message, if it is not JSON. */
static json_t *read_scene(const char *path)
{
    json_error_t mistake;
    FILE *stream = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    if (stream == NULL) {
        (void)fprintf(stderr, "talus: cannot open %s: %s\n", path, strerror(errno));
        return NULL;
    }
    json_t *scene = json_loadf(stream, JSON_REJECT_DUPLICATES, &mistake);
    if (scene == NULL)
        (void)fprintf(stderr, "talus: %s is not JSON: line %d, column %d: %s\n", path, mistake.line,
                      mistake.column, mistake.text);
    if (stream != stdin)
        (void)fclose(stream);
    return scene;
}

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
    json_t *scene = read_scene(arguments->operands[0]);
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

/* A random key makes it safe to send a submission again when its answer was lost. */
static bool make_key(const char *given, char *header, size_t size)
{
    unsigned char bytes[16];
    if (given != NULL)
        return snprintf(header, size, "Idempotency-Key: %s", given) < (int)size;
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return false;
    size_t length = (size_t)snprintf(header, size, "Idempotency-Key: ");
    for (size_t index = 0; index < sizeof bytes; index++)
        length += (size_t)snprintf(header + length, size - length, "%02x", bytes[index]);
    return true;
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
    if (reply->status / 100 != 2) {
        problem_print(stderr, reply->status, reply->body, reply->length);
        return EXIT_REFUSED;
    }
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
    char key[512], problem[256] = "";
    const bool check = arguments_has(arguments, "check");
    if (!make_key(arguments_value(arguments, "idempotency-key"), key, sizeof key)) {
        (void)fprintf(stderr, "talus: the idempotency key is too long\n");
        return EXIT_USAGE;
    }
    struct http_request request = {.method = "POST",
                                   .path = check ? "/v1/forecast" : "/v1/jobs",
                                   .body = body,
                                   .headers = {check ? NULL : key}};
    for (int attempt = 0; attempt < 3; attempt++) {
        struct http_reply reply;
        const bool answered =
            connection_send(connection, &request, &reply, problem, sizeof problem);
        const bool again = !answered && reply.status == 0 && attempt < 2;
        const int code = answered ? take_answer(connection, &reply, id) : EXIT_NO_SERVER;
        http_reply_release(&reply);
        if (!again) {
            if (!answered)
                (void)fprintf(stderr, "talus: %s\n", problem);
            return code;
        }
        (void)nanosleep(&(struct timespec){.tv_nsec = 300000000}, NULL);
    }
    return EXIT_NO_SERVER;
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

/* SPDX-License-Identifier: Apache-2.0 */
#include "watch.h"

#include "event_parser.h"
#include "job_text.h"
#include "live_view.h"
#include "problem_text.h"
#include "reaction_table.h"
#include "subcommand.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double patience = 60.0;      /* [s] without a server before giving up */
static const double plain_interval = 5.0; /* [s] between plain lines of progress */

struct watch {
    struct connection *connection;
    const char *id, *only;
    struct event_parser parser;
    struct reaction_table reactions;
    struct live_view view;
    char unit[16]; /* of a force; "" until it is known */
    char state[24];
    double plain_at; /* [s] time of the last plain line of progress */
    long event_count;
    double heard_at; /* [s] when the server was last heard of */
    bool done;
};

static double now(void)
{
    struct timespec time;
    (void)clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* The unit of the forces in a list of series. */
static void take_unit(struct watch *watch, const struct http_reply *reply)
{
    size_t index;
    json_t *series;
    json_t *list = json_loadb(reply->body == NULL ? "" : reply->body, reply->length, 0, NULL);
    json_array_foreach(list, index, series)
    {
        char name[96];
        int component;
        const char *unit = json_text(series, "unit");
        if (unit[0] != '\0' &&
            reaction_series_parse(json_text(series, "name"), name, sizeof name, &component))
            (void)snprintf(watch->unit, sizeof watch->unit, "%s", unit);
    }
    json_decref(list);
}

/* The unit of a force depends on the dimension of the scene: asked once, on a connection of its
 * own since the other one is streaming. Without an answer forces are in N. */
static void find_unit(struct watch *watch)
{
    struct connection second;
    struct http_reply reply = {0};
    char problem[256];
    (void)snprintf(watch->unit, sizeof watch->unit, "N");
    char *path = job_path(watch->id, "/series", NULL);
    const bool open =
        connection_open(&second, watch->connection->server, watch->connection->token) == EXIT_DONE;
    const struct http_request request = {.method = "GET", .path = path};
    if (path != NULL && open &&
        connection_send(&second, &request, &reply, problem, sizeof problem) && reply.status == 200)
        take_unit(watch, &reply);
    http_reply_release(&reply);
    connection_close(&second);
    free(path);
}

/* Whether a reaction is among those to show: a boundary as a whole unless one was asked for. */
static bool is_shown(const struct watch *watch, const struct reaction *reaction)
{
    if (watch->only != NULL)
        return strcmp(reaction->name, watch->only) == 0;
    /* A face of an obstacle is named after it; the whole comes too. */
    for (size_t index = 0; index < watch->reactions.count; index++) {
        const char *other = watch->reactions.items[index].name;
        const size_t length = strlen(other);
        if (strncmp(reaction->name, other, length) == 0 && reaction->name[length] == '.')
            return false;
    }
    return true;
}

static void show_reactions(struct watch *watch)
{
    int line = 1;
    for (size_t index = 0; index < watch->reactions.count && line < LIVE_LINE_MAX; index++) {
        char text[LIVE_LINE_SIZE];
        if (!is_shown(watch, &watch->reactions.items[index]))
            continue;
        reaction_format(&watch->reactions.items[index], watch->unit, text, sizeof text);
        live_view_set(&watch->view, line++, text);
    }
    live_view_truncate(&watch->view, line);
    live_view_draw(&watch->view);
}

static void on_progress(struct watch *watch, const json_t *data)
{
    char text[LIVE_LINE_SIZE - 32], line[LIVE_LINE_SIZE];
    progress_format(data, text, sizeof text);
    (void)snprintf(line, sizeof line, "%s %s", watch->state, text);
    live_view_set(&watch->view, 0, line);
    if (watch->view.terminal) {
        live_view_draw(&watch->view);
        return;
    }
    if (now() - watch->plain_at < plain_interval)
        return;
    watch->plain_at = now();
    for (int index = 0; index < watch->view.count; index++)
        live_view_print(&watch->view, "%s", watch->view.lines[index]);
}

static void on_reaction(struct watch *watch, const json_t *data)
{
    if (watch->unit[0] == '\0')
        find_unit(watch);
    if (!reaction_table_add(&watch->reactions, data))
        live_view_print(&watch->view, "talus: out of memory: forces are incomplete");
    show_reactions(watch);
}

static void on_state(struct watch *watch, const json_t *data)
{
    const char *state = json_text(data, "state");
    char line[LIVE_LINE_SIZE];
    (void)snprintf(watch->state, sizeof watch->state, "%s", state);
    (void)snprintf(line, sizeof line, "%s", state);
    live_view_set(&watch->view, 0, line);
    live_view_print(&watch->view, "%s  %s", json_text(data, "at"), state);
}

static void on_warning(struct watch *watch, const json_t *data)
{
    live_view_print(&watch->view, "warning: %s%s%s", json_text(data, "pointer"),
                    json_text(data, "pointer")[0] == '\0' ? "" : ": ", json_text(data, "detail"));
}

static void on_rewind(struct watch *watch, const json_t *data)
{
    const double time = json_number_value(json_object_get(data, "time"));
    reaction_table_rewind(&watch->reactions, time);
    live_view_print(&watch->view, "goes on from the checkpoint at t = %.4g s", time);
}

static void on_gap(struct watch *watch, const json_t *data)
{
    (void)data;
    live_view_print(&watch->view,
                    "this reader was too slow: some events were left out, peaks may be missing");
}

static void on_done(struct watch *watch, const json_t *data)
{
    (void)data;
    watch->done = true;
}

struct handler {
    const char *event;
    void (*handle)(struct watch *watch, const json_t *data);
};

static const struct handler handlers[] = {
    {"state", on_state},   {"progress", on_progress}, {"reaction", on_reaction},
    {"rewind", on_rewind}, {"warning", on_warning},   {"gap", on_gap},
    {"done", on_done},
};

static bool take_event(void *context, const char *name, const char *id, const char *text)
{
    struct watch *watch = context;
    json_t *data = json_loads(text, JSON_DECODE_ANY, NULL);
    watch->event_count++;
    if (watch->connection->json) {
        (void)printf("{\"event\":\"%s\",\"id\":\"%s\",\"data\":%s}\n", name, id,
                     data == NULL ? "null" : text);
        (void)fflush(stdout);
        watch->done = watch->done || strcmp(name, "done") == 0;
        json_decref(data);
        return !watch->done;
    }
    for (size_t index = 0; index < sizeof handlers / sizeof handlers[0]; index++) {
        if (strcmp(handlers[index].event, name) == 0)
            handlers[index].handle(watch, data);
    }
    json_decref(data);
    return !watch->done;
}

static bool take_bytes(void *context, const char *bytes, size_t length)
{
    struct watch *watch = context;
    watch->heard_at = now();
    return event_parser_feed(&watch->parser, bytes, length);
}

/* One connection to the stream. EXIT_DONE: the job's end was told, or the connection ended and may
 * be taken up again. */
static int follow_once(struct watch *watch, const char *path, bool first)
{
    char header[96], problem[256];
    struct http_reply reply;
    struct http_request request = {.method = "GET",
                                   .path = path,
                                   .headers = {"Accept: text/event-stream"},
                                   .receive = take_bytes,
                                   .context = watch,
                                   .endless = true};
    if (watch->parser.id[0] != '\0') {
        (void)snprintf(header, sizeof header, "Last-Event-ID: %s", watch->parser.id);
        request.headers[1] = header;
    }
    int code = EXIT_DONE;
    const bool answered =
        connection_send(watch->connection, &request, &reply, problem, sizeof problem);
    if (!answered && ((first && reply.status == 0) || now() - watch->heard_at > patience)) {
        live_view_finish(&watch->view);
        (void)fprintf(stderr, "talus: %s\n", problem);
        code = EXIT_NO_SERVER;
    } else if (reply.status == 204) { /* nothing follows what is known already */
        watch->done = true;
    } else if (reply.status / 100 != 2 && reply.status != 0 && (first || reply.status != 503)) {
        live_view_finish(&watch->view);
        problem_print(stderr, reply.status, reply.body, reply.length);
        code = EXIT_REFUSED;
    }
    http_reply_release(&reply);
    event_parser_restart(&watch->parser);
    return code;
}

static void wait_seconds(double seconds)
{
    const struct timespec time = {.tv_sec = (time_t)seconds,
                                  .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))};
    (void)nanosleep(&time, NULL);
}

static int follow(struct watch *watch)
{
    double delay = 0.2;
    char *path = job_path(watch->id, "/events", NULL);
    if (path == NULL)
        return EXIT_USAGE;
    int code = follow_once(watch, path, true);
    while (code == EXIT_DONE && !watch->done) {
        const long before = watch->event_count;
        wait_seconds(delay);
        code = follow_once(watch, path, false);
        delay = watch->event_count > before ? 0.2 : delay < 4.0 ? 2.0 * delay : delay;
    }
    free(path);
    return code;
}

/* The job has ended: what came of it. */
static int report_end(struct watch *watch)
{
    json_t *job = NULL;
    char *path = job_path(watch->id, "", NULL);
    if (path == NULL)
        return EXIT_USAGE;
    const struct http_request request = {.method = "GET", .path = path};
    int code = connection_ask(watch->connection, &request, &job);
    if (code == EXIT_DONE) {
        if (!watch->connection->json)
            job_print_result(stdout, job);
        code = job_exit_code(job);
    }
    json_decref(job);
    free(path);
    return code;
}

int watch_job(struct connection *connection, const char *id, const char *only)
{
    struct watch watch = {.connection = connection, .id = id, .only = only, .heard_at = now()};
    watch.parser.emit = take_event;
    watch.parser.context = &watch;
    live_view_init(&watch.view, stdout);
    int code = follow(&watch);
    if (code == EXIT_DONE) {
        if (!connection->json)
            live_view_finish(&watch.view);
        code = report_end(&watch);
    }
    event_parser_release(&watch.parser);
    reaction_table_release(&watch.reactions);
    return code;
}

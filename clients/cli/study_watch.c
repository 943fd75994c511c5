/* SPDX-License-Identifier: Apache-2.0 */
#include "study_watch.h"

#include "job_text.h"
#include "live_view.h"
#include "problem_text.h"
#include "study_text.h"
#include "subcommand.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double patience = 60;      /* [s] without a server before giving up */
static const double plain_interval = 5; /* [s] between plain lines */

struct study_watcher {
    struct connection *connection;
    char *path, *waiting_path;
    struct live_view view;
    json_int_t revision; /* last seen; -1: none */
    double heard_at, plain_at;
    json_t *study; /* as last seen, owned */
};

static double now(void)
{
    struct timespec time;
    (void)clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void show(struct study_watcher *watcher)
{
    char line[LIVE_LINE_SIZE];
    const json_int_t revision = json_integer_value(json_object_get(watcher->study, "revision"));
    const bool changed = revision != watcher->revision;
    watcher->revision = revision;
    if (watcher->connection->json) {
        if (changed) {
            (void)json_dumpf(watcher->study, stdout, JSON_COMPACT);
            (void)printf("\n");
            (void)fflush(stdout);
        }
        return;
    }
    study_format(watcher->study, line, sizeof line);
    live_view_set(&watcher->view, 0, line);
    if (watcher->view.terminal) {
        live_view_draw(&watcher->view);
    } else if (changed && now() - watcher->plain_at >= plain_interval) {
        watcher->plain_at = now();
        live_view_print(&watcher->view, "%s", line);
    }
}

/* Asks once; `waiting` answers when the study has changed, or after a while. EXIT_DONE also when
 * the server is to be asked again. */
static int look(struct study_watcher *watcher, bool waiting)
{
    char header[64], problem[256];
    struct http_reply reply;
    struct http_request request = {.method = "GET",
                                   .path = waiting ? watcher->waiting_path : watcher->path};
    (void)snprintf(header, sizeof header, "If-None-Match: \"%lld\"", (long long)watcher->revision);
    if (waiting)
        request.headers[0] = header;
    int code = EXIT_DONE;
    bool answered = connection_send(watcher->connection, &request, &reply, problem, sizeof problem);
    if (answered && reply.status == 200) {
        json_decref(watcher->study);
        watcher->study = json_loadb(reply.body == NULL ? "" : reply.body, reply.length, 0, NULL);
        watcher->heard_at = now();
        show(watcher);
    } else if (answered && reply.status != 304 && reply.status != 503) {
        problem_print(stderr, reply.status, reply.body, reply.length);
        code = EXIT_REFUSED;
    } else if (!answered && (watcher->study == NULL || now() - watcher->heard_at > patience)) {
        (void)fprintf(stderr, "talus: %s\n", problem);
        code = EXIT_NO_SERVER;
    } else if (!answered || reply.status == 503) {
        (void)nanosleep(&(struct timespec){.tv_sec = 1}, NULL);
    }
    http_reply_release(&reply);
    return code;
}

static bool ended(const json_t *study)
{
    return study != NULL && strcmp(json_text(study, "state"), "running") != 0;
}

int study_watch(struct connection *connection, const char *id)
{
    struct study_watcher watcher = {.connection = connection,
                                    .revision = -1,
                                    .path = resource_path("studies", id, "", NULL),
                                    .waiting_path = resource_path("studies", id, "?wait=2", NULL)};
    int code = watcher.path == NULL || watcher.waiting_path == NULL ? EXIT_USAGE : EXIT_DONE;
    live_view_init(&watcher.view, stdout);
    if (code == EXIT_DONE)
        code = look(&watcher, false);
    while (code == EXIT_DONE && !ended(watcher.study)) {
        code = look(&watcher, true);
        /* Progress is no change of the study, so it is asked for. */
        if (code == EXIT_DONE && !ended(watcher.study))
            code = look(&watcher, false);
    }
    if (!connection->json)
        live_view_finish(&watcher.view);
    if (code == EXIT_DONE) {
        if (!connection->json)
            study_print(stdout, watcher.study);
        code = study_exit_code(watcher.study);
    }
    json_decref(watcher.study);
    free(watcher.path);
    free(watcher.waiting_path);
    return code;
}

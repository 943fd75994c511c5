/* SPDX-License-Identifier: Apache-2.0 */
#include "service_metrics.h"

#include "moment.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>

/* Upper bounds of the latencies that are told apart [s]; the last class is open. */
static const double bounds[] = {0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,
                                0.25,   0.5,   1,      2.5,   5,    10,    60};
enum { BOUND_COUNT = sizeof bounds / sizeof bounds[0], STATUS_MAX = 24 };

/* The answers of one route with one status. */
struct answers {
    unsigned int status; /* 0: not used yet */
    uint64_t classes[BOUND_COUNT + 1];
    double seconds;
};

struct metrics {
    pthread_mutex_t mutex;
    struct answers (*routes)[STATUS_MAX]; /* [request_route_count + 1]; the last: of no route */
    uint64_t begun, restarted, ended[JOB_END_LOST + 1];
};

enum talus_status metrics_create(struct metrics **result, struct talus_error *error)
{
    struct metrics *metrics = calloc(1, sizeof *metrics);
    *result = metrics;
    if (metrics != NULL)
        metrics->routes = calloc(request_route_count + 1, sizeof *metrics->routes);
    if (metrics == NULL || metrics->routes == NULL) {
        free(metrics);
        *result = NULL;
        return talus_error_memory(error);
    }
    (void)pthread_mutex_init(&metrics->mutex, NULL);
    return TALUS_OK;
}

void metrics_destroy(struct metrics *metrics)
{
    if (metrics == NULL)
        return;
    (void)pthread_mutex_destroy(&metrics->mutex);
    free(metrics->routes);
    free(metrics);
}

/* The place for a status; the last one takes what there is no place for. */
static struct answers *answers_find(struct answers *list, unsigned int status)
{
    size_t index = 0;
    while (index + 1 < STATUS_MAX && list[index].status != 0 && list[index].status != status)
        index++;
    if (list[index].status == 0)
        list[index].status = status;
    return &list[index];
}

void metrics_request(struct metrics *metrics, const struct request *request)
{
    const double seconds = moment_monotonic() - request->began;
    size_t route =
        request->route == NULL ? request_route_count : (size_t)(request->route - request_routes);
    size_t class = 0;
    while (class < BOUND_COUNT && seconds > bounds[class])
        class ++;
    (void)pthread_mutex_lock(&metrics->mutex);
    struct answers *answers = answers_find(metrics->routes[route], request->reply.status);
    answers->classes[class]++;
    answers->seconds += seconds;
    (void)pthread_mutex_unlock(&metrics->mutex);
}

void metrics_attempt_begin(struct metrics *metrics, bool again)
{
    (void)pthread_mutex_lock(&metrics->mutex);
    metrics->begun++;
    metrics->restarted += again;
    (void)pthread_mutex_unlock(&metrics->mutex);
}

void metrics_attempt_end(struct metrics *metrics, enum job_end end)
{
    (void)pthread_mutex_lock(&metrics->mutex);
    metrics->ended[end]++;
    (void)pthread_mutex_unlock(&metrics->mutex);
}

void metrics_print_head(struct text *text, const char *name, const char *type, const char *help)
{
    text_print(text, "# HELP %s %s\n# TYPE %s %s\n", name, help, name, type);
}

static void answers_print(struct text *text, const struct answers *answers, const char *labels)
{
    static const char name[] = "talus_http_request_duration_seconds";
    uint64_t count = 0;
    for (size_t class = 0; class <= BOUND_COUNT; class ++) {
        count += answers->classes[class];
        text_print(text, "%s_bucket{%s,le=\"", name, labels);
        if (class < BOUND_COUNT)
            text_print(text, "%g", bounds[class]);
        else
            text_add_string(text, "+Inf");
        text_print(text, "\"} %" PRIu64 "\n", count);
    }
    text_print(text, "%s_sum{%s} %.9g\n%s_count{%s} %" PRIu64 "\n", name, labels, answers->seconds,
               name, labels, count);
}

static void routes_print(const struct metrics *metrics, struct text *text)
{
    metrics_print_head(text, "talus_http_request_duration_seconds", "histogram",
                       "Time from the header fields of a request to its answer, or to the "
                       "beginning of a stream.");
    for (size_t route = 0; route <= request_route_count; route++) {
        for (size_t index = 0; index < STATUS_MAX; index++) {
            const struct answers *answers = &metrics->routes[route][index];
            struct text labels = {0};
            if (answers->status == 0)
                continue;
            text_print(&labels, "method=\"%s\",route=\"%s%s\",status=\"%u\"",
                       route < request_route_count ? request_routes[route].method : "other",
                       route < request_route_count ? "/" : "",
                       route < request_route_count ? request_routes[route].path : "none",
                       answers->status);
            if (!labels.failed)
                answers_print(text, answers, labels.data);
            text_release(&labels);
        }
    }
}

void metrics_print(struct metrics *metrics, struct text *text)
{
    static const char *const ends[] = {
        [JOB_END_SUCCEEDED] = "succeeded", [JOB_END_FAILED] = "failed",
        [JOB_END_CANCELLED] = "cancelled", [JOB_END_CRASHED] = "crashed",
        [JOB_END_LOST] = "lost",
    };
    (void)pthread_mutex_lock(&metrics->mutex);
    routes_print(metrics, text);
    metrics_print_head(text, "talus_attempts_begun_total", "counter", "Attempts of jobs begun.");
    text_print(text, "talus_attempts_begun_total %" PRIu64 "\n", metrics->begun);
    metrics_print_head(text, "talus_restarts_total", "counter",
                       "Attempts begun that were not the first of their job.");
    text_print(text, "talus_restarts_total %" PRIu64 "\n", metrics->restarted);
    metrics_print_head(text, "talus_attempts_ended_total", "counter", "Attempts that ended, how.");
    for (size_t end = 0; end <= JOB_END_LOST; end++)
        text_print(text, "talus_attempts_ended_total{end=\"%s\"} %" PRIu64 "\n", ends[end],
                   metrics->ended[end]);
    (void)pthread_mutex_unlock(&metrics->mutex);
}

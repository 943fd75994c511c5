/* SPDX-License-Identifier: Apache-2.0 */
/* GET /metrics: what there is now, and what was counted. */
#include "access.h"
#include "audit.h"
#include "calibration.h"
#include "events.h"
#include "folder.h"
#include "moment.h"
#include "request.h"
#include "service.h"
#include "service_metrics.h"
#include "supervisor.h"
#include "talus/version.h"
#include "work_lanes.h"

#include <inttypes.h>
#include <string.h>
#include <sys/resource.h>

static void number_print(struct text *text, const char *name, const char *type, double value,
                         const char *help)
{
    metrics_print_head(text, name, type, help);
    text_print(text, "%s %.15g\n", name, value);
}

static void jobs_print(struct text *text, struct store *store)
{
    int64_t counts[JOB_STATE_COUNT];
    struct talus_error error = {0};
    if (store_job_counts(store, counts, &error) != TALUS_OK)
        return;
    metrics_print_head(text, "talus_jobs", "gauge", "Jobs, by state.");
    for (size_t state = 0; state < JOB_STATE_COUNT; state++)
        text_print(text, "talus_jobs{state=\"%s\"} %" PRId64 "\n",
                   job_state_name((enum job_state)state), counts[state]);
    number_print(text, "talus_queue_depth", "gauge", (double)counts[JOB_QUEUED],
                 "Jobs that wait for threads.");
}

static double cpu_seconds(int who)
{
    struct rusage usage;
    if (getrusage(who, &usage) != 0)
        return 0;
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static void service_print(struct text *text, struct service *service)
{
    const double free_bytes = folder_free_bytes(service->state);
    number_print(text, "talus_threads", "gauge", service->config->workers,
                 "Threads that may run at once over all jobs.");
    number_print(text, "talus_threads_busy", "gauge",
                 (double)supervisor_threads(service->supervisor), "Threads of running jobs.");
    number_print(text, "talus_event_readers", "gauge", (double)events_reader_count(service->events),
                 "Open event streams.");
    number_print(text, "talus_requests_under_way", "gauge",
                 (double)lanes_busy_count(service->lanes),
                 "Requests that are queued or being answered.");
    number_print(text, "talus_store_commits_total", "counter",
                 (double)store_commit_count(service->store), "Commits of the database.");
    number_print(text, "talus_store_healthy", "gauge", store_healthy(service->store),
                 "Whether the database takes writes.");
    if (free_bytes >= 0)
        number_print(text, "talus_disk_free_bytes", "gauge", free_bytes,
                     "Free space where the state is.");
    number_print(text, "talus_worker_cpu_seconds_total", "counter", cpu_seconds(RUSAGE_CHILDREN),
                 "Processor time of workers and helpers that have ended.");
    number_print(text, "talus_daemon_cpu_seconds_total", "counter", cpu_seconds(RUSAGE_SELF),
                 "Processor time of the daemon itself.");
    number_print(text, "talus_uptime_seconds", "gauge", moment_monotonic() - service->began,
                 "Time since the daemon started.");
    number_print(text, "talus_tokens", "gauge", (double)access_token_count(service->access),
                 "Access tokens in force.");
    number_print(text, "talus_tokens_stale", "gauge", access_is_stale(service->access),
                 "Whether the token file has mistakes, so that the tokens of before are in force.");
    number_print(text, "talus_audit_lost_total", "counter",
                 (double)audit_lost_count(service->audit),
                 "Lines that the audit log lacks: the file took no writes.");
    number_print(text, "talus_draining", "gauge", atomic_load(&service->draining),
                 "Whether the daemon is stopping and takes no work.");
    metrics_print_head(text, "talus_build_info", "gauge", "The build, as labels; always 1.");
    text_print(text, "talus_build_info{version=\"%s\",build=\"%s\"} 1\n", TALUS_VERSION,
               talus_build());
}

/* How good forecasts were: of jobs that ran as they were forecast. */
static void forecasts_print(struct text *text, struct calibration *calibration)
{
    struct calibration_summary quality;
    calibration_summarise(calibration, &quality);
    number_print(text, "talus_forecast_judged_total", "counter", (double)quality.judged,
                 "Jobs whose wall time was compared with its forecast.");
    number_print(text, "talus_forecast_inside_total", "counter", (double)quality.inside,
                 "Of these, those that ended inside the interval.");
    if (quality.judged > 0)
        number_print(text, "talus_forecast_inside_ratio", "gauge", quality.recent,
                     "Share of the last hundred or so that ended inside.");
    number_print(text, "talus_forecast_statistics", "gauge", (double)quality.names,
                 "Methods and classes of which something has been learned.");
}

const struct operation operation_metrics = {
    .summary = "What the daemon counts, for Prometheus",
    .responses =
        (const struct response[]){
            {.status = 200, .type = "text/plain", .meaning = "Prometheus' text format, 0.0.4"},
            RESPONSE_END},
};

enum handled handle_metrics(struct request *request)
{
    struct service *service = request->service;
    struct text text = {0};
    jobs_print(&text, service->store);
    service_print(&text, service);
    forecasts_print(&text, service->calibration);
    metrics_print(service->metrics, &text);
    reply_text(&request->reply, MHD_HTTP_OK, "text/plain; version=0.0.4; charset=utf-8", &text);
    reply_header(&request->reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
    return HANDLED;
}

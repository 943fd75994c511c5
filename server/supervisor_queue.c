/* SPDX-License-Identifier: Apache-2.0 */
/* The part of the supervisor that starts queued jobs. */
#include "attempt_load.h"
#include "executor_local.h"
#include "jobs.h"
#include "service_metrics.h"
#include "supervisor_internal.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double spawn_retry_seconds = 1;

struct candidates {
    const struct fair_share *share;
    struct scheduler_candidate *items;
    size_t count, capacity;
    int64_t workers;      /* no job is wider than the machine is now */
    double quota_running; /* jobs of one owner that run at once, 0: any */
    bool failed;
};

static void candidate_add(const struct store_queued *job, void *context)
{
    struct candidates *candidates = context;
    const char *owner = job->owner == NULL ? "" : job->owner;
    if (candidates->quota_running > 0 &&
        (double)fair_share_jobs(candidates->share, owner) >= candidates->quota_running)
        return;
    if (candidates->count == candidates->capacity) {
        size_t capacity = candidates->capacity == 0 ? 64 : 2 * candidates->capacity;
        struct scheduler_candidate *items =
            realloc(candidates->items, capacity * sizeof *candidates->items);
        candidates->failed = candidates->failed || items == NULL;
        if (items == NULL)
            return;
        candidates->items = items;
        candidates->capacity = capacity;
    }
    struct scheduler_candidate *candidate = &candidates->items[candidates->count++];
    *candidate = (struct scheduler_candidate){.priority = job->priority};
    (void)snprintf(candidate->id, sizeof candidate->id, "%s", job->id);
    (void)snprintf(candidate->owner, sizeof candidate->owner, "%s", owner);
    candidate->threads = job->threads < candidates->workers ? job->threads : candidates->workers;
}

/* Begins an attempt under its lock, which the worker inherits; without a lock (the folder is gone)
 * it ends at once. */
static enum talus_status attempt_begin(struct supervisor *supervisor, const char *id,
                                       const char *folder, int lock, struct talus_error *error)
{
    struct service *service = supervisor->service;
    struct job job = {0};
    pid_t pid = 0;
    enum talus_status status = jobs_begin(service, id, &job, error);
    if (status != TALUS_OK)
        return status;
    if (job.threads > (int64_t)service->config->workers)
        job.threads = (int64_t)service->config->workers;
    metrics_attempt_begin(service->metrics, job.attempt > 1);
    const struct executor_task task = {
        .program = service->config->worker_program,
        .folder = folder,
        .threads = job.threads,
        .attempt = job.attempt,
        .resume = job.attempt > 1,
        .lock = lock,
        .memory_limit = job.memory_limit,
        .disk_limit = job.disk_limit,
    };
    const struct job_outcome not_started = {.end = JOB_END_CRASHED,
                                            .reason = "crashed",
                                            .detail = error->text,
                                            .exit_code = -1,
                                            .signal_number = -1};
    status = lock < 0 ? TALUS_IO : TALUS_OK;
    if (status == TALUS_OK && job.steering != NULL)
        status = jobs_orders_write(service, id, error);
    if (status == TALUS_OK)
        status = executor_start(&task, &pid, error);
    if (status != TALUS_OK) {
        struct talus_error second = {0};
        if (jobs_finish(service, id, lock < 0 ? &supervisor_folder_gone : &not_started, &second) !=
            TALUS_OK)
            (void)fprintf(stderr, "talusd: job %s: %s\n", id, second.text);
    } else if (!supervisor_attempt_add(supervisor, &job, pid)) {
        executor_signal(pid, SIGKILL);
        status = talus_error_memory(error);
    }
    job_release(&job);
    return status;
}

static bool job_start(struct supervisor *supervisor, const char *id)
{
    struct talus_error error = {0};
    char *folder = jobs_folder(supervisor->service, id);
    int lock = folder == NULL ? -1 : event_log_lock(folder);
    bool good = lock >= 0 || errno == ENOENT;
    if (good) {
        enum talus_status status = attempt_begin(supervisor, id, folder, lock, &error);
        good = status == TALUS_OK || lock < 0 || strcmp(error.code, "state") == 0 ||
               strcmp(error.code, "not_found") == 0;
    }
    if (lock >= 0)
        (void)close(lock);
    if (error.status != TALUS_OK && !good)
        (void)fprintf(stderr, "talusd: job %s: %s\n", id, error.text);
    free(folder);
    return good;
}

static int64_t threads_free(const struct supervisor *supervisor)
{
    return (int64_t)supervisor->service->config->workers - attempt_load_threads(supervisor->first);
}

/* Notes what runs, for the order of what waits. */
static void share_note(struct supervisor *supervisor, double now)
{
    fair_share_begin(&supervisor->share, now);
    for (const struct attempt *attempt = supervisor->first; attempt != NULL;
         attempt = attempt->next)
        (void)fair_share_note(&supervisor->share, attempt->owner, attempt->threads);
}

/* Starts the job whose turn it is. False: none may start now. */
static bool next_start(struct supervisor *supervisor, double now)
{
    struct service *service = supervisor->service;
    struct candidates candidates = {.share = &supervisor->share,
                                    .workers = (int64_t)service->config->workers,
                                    .quota_running = service->config->quota_running};
    struct talus_error error = {0};
    uint64_t count = store_commit_count(service->store);
    bool started = false;
    if (count != supervisor->empty_at &&
        store_queue_heads(service->store, candidate_add, &candidates, &error) == TALUS_OK &&
        !candidates.failed) {
        fair_share_order(&supervisor->share, candidates.items, candidates.count);
        size_t index = scheduler_pick(&supervisor->scheduler, candidates.items, candidates.count,
                                      threads_free(supervisor), now);
        started = index < candidates.count;
        if (started && !job_start(supervisor, candidates.items[index].id))
            supervisor->start_after = now + spawn_retry_seconds;
        /* With a quota it may be the end of a job that lets another one start. */
        if (candidates.count == 0 && service->config->quota_running <= 0)
            supervisor->empty_at = count;
    }
    free(candidates.items);
    if (started)
        share_note(supervisor, now);
    return started;
}

void supervisor_jobs_start(struct supervisor *supervisor, double now)
{
    bool more = true;
    share_note(supervisor, now);
    while (more && !atomic_load(&supervisor->service->draining) && now >= supervisor->start_after &&
           threads_free(supervisor) > 0)
        more = next_start(supervisor, now);
}

double supervisor_patience(struct supervisor *supervisor)
{
    double least = 60;
    (void)pthread_mutex_lock(&supervisor->mutex);
    if (threads_free(supervisor) > 0)
        least = 1;
    for (const struct attempt *attempt = supervisor->first; attempt != NULL;
         attempt = attempt->next) {
        const json_t *eta = json_object_get(attempt->progress, "eta_seconds");
        if (json_is_number(eta) && json_number_value(eta) < least)
            least = json_number_value(eta);
    }
    (void)pthread_mutex_unlock(&supervisor->mutex);
    return least < 1 ? 1 : least;
}

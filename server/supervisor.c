/* SPDX-License-Identifier: Apache-2.0 */
#include "attempt_load.h"
#include "calibration.h"
#include "events.h"
#include "executor_local.h"
#include "folder.h"
#include "jobs.h"
#include "moment.h"
#include "service_metrics.h"
#include "supervisor_internal.h"
#include "wakeup.h"

#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/pidfd.h>
#include <unistd.h>

/* Between two looks: at nothing; at workers that run; at one that begins, ends or is to end. */
enum { IDLE_MILLISECONDS = 1000, CALM_MILLISECONDS = 250, TICK_MILLISECONDS = 50 };
static const double disk_check_seconds = 0.5;
static const char wakeup_name[] = "the supervisor";

enum talus_status supervisor_create(struct supervisor **result, struct service *service,
                                    struct talus_error *error)
{
    struct supervisor *supervisor = calloc(1, sizeof *supervisor);
    *result = supervisor;
    if (supervisor == NULL)
        return talus_error_memory(error);
    supervisor->service = service;
    supervisor->empty_at = UINT64_MAX;
    supervisor->wake = -1;
    (void)pthread_mutex_init(&supervisor->mutex, NULL);
    supervisor->ends = epoll_create1(EPOLL_CLOEXEC);
    enum talus_status status =
        supervisor->ends >= 0
            ? wakeup_create(&supervisor->wake, error)
            : talus_error_set(error, TALUS_INTERNAL, "epoll", "", "cannot make an epoll");
    if (status != TALUS_OK) {
        supervisor_destroy(supervisor);
        *result = NULL;
    }
    return status;
}

void supervisor_wake(struct supervisor *supervisor)
{
    if (supervisor != NULL)
        wakeup_tell(supervisor->wake, wakeup_name);
}

json_t *supervisor_progress(struct supervisor *supervisor, const char *id)
{
    json_t *progress = NULL;
    (void)pthread_mutex_lock(&supervisor->mutex);
    for (struct attempt *attempt = supervisor->first; attempt != NULL; attempt = attempt->next) {
        if (strcmp(attempt->id, id) == 0 && attempt->progress != NULL)
            progress = json_deep_copy(attempt->progress);
    }
    (void)pthread_mutex_unlock(&supervisor->mutex);
    return progress;
}

uint64_t supervisor_progress_count(const struct supervisor *supervisor)
{
    return atomic_load(&supervisor->progress_count);
}

/* Has the thread woken when a child ends; where that fails it looks often instead. */
static void end_watch(struct supervisor *supervisor, struct attempt *attempt)
{
    struct epoll_event event = {.events = EPOLLIN | EPOLLONESHOT};
    attempt->end = pidfd_open(attempt->pid, 0);
    if (attempt->end >= 0 &&
        epoll_ctl(supervisor->ends, EPOLL_CTL_ADD, attempt->end, &event) != 0) {
        (void)close(attempt->end);
        attempt->end = -1;
    }
}

bool supervisor_attempt_add(struct supervisor *supervisor, const struct job *job, pid_t pid)
{
    char *folder = jobs_folder(supervisor->service, job->id);
    struct attempt *attempt =
        folder == NULL ? NULL : attempt_create(job, folder, supervisor->service->boot);
    free(folder);
    if (attempt == NULL)
        return false;
    attempt->pid = pid;
    if (pid > 0)
        end_watch(supervisor, attempt);
    (void)pthread_mutex_lock(&supervisor->mutex);
    attempt->next = supervisor->first;
    supervisor->first = attempt;
    (void)pthread_mutex_unlock(&supervisor->mutex);
    return true;
}

enum talus_status supervisor_adopt(struct supervisor *supervisor, const char *id,
                                   struct talus_error *error)
{
    struct job job = {0};
    enum talus_status status = store_job_read(supervisor->service->store, id, &job, error);
    /* What a dead daemon noted may not have reached the file. */
    if (status == TALUS_OK && job.steering != NULL)
        status = jobs_orders_write(supervisor->service, id, error);
    if (status == TALUS_OK && !supervisor_attempt_add(supervisor, &job, 0))
        status = talus_error_memory(error);
    job_release(&job);
    return status;
}

static void attempt_signal(const struct attempt *attempt, int signal_number)
{
    if (attempt->pid > 0 && !attempt->ended)
        executor_signal(attempt->pid, signal_number);
    else
        executor_signal_holders(attempt->folder, signal_number);
}

/* Asks a worker to stop, and ends it when it does not. */
static void attempt_stop(struct supervisor *supervisor, struct attempt *attempt, double now)
{
    if (attempt->stop_deadline <= 0) {
        attempt_signal(attempt, SIGTERM);
        attempt->stop_deadline = now + supervisor->service->config->stop_seconds;
    } else if (now > attempt->stop_deadline) {
        attempt_signal(attempt, SIGKILL);
        attempt->stop_deadline = now + 1;
    }
}

/* Sees to what has changed in the job, and passes it on to the worker. The store is asked only when
 * something has changed there. */
static void attempt_refresh(struct supervisor *supervisor, struct attempt *attempt)
{
    struct store *store = supervisor->service->store;
    uint64_t count = store_commit_count(store);
    if (count != attempt->commit_count) {
        struct job job = {0};
        struct talus_error error = {0};
        bool known = store_job_read(store, attempt->id, &job, &error) == TALUS_OK;
        if (known && job.revision != attempt->revision && attempt_update(attempt, &job))
            executor_limit(attempt->ended ? 0 : attempt->pid, attempt->folder,
                           attempt->memory_limit, attempt->disk_limit);
        if (known)
            attempt->commit_count = count;
        job_release(&job);
    }
    /* Before its `started` line a worker may not expect a signal; it looks at its orders then. */
    if (attempt->orders_pending && attempt->worker_started) {
        attempt->orders_pending = false;
        attempt_signal(attempt, SIGUSR1);
    }
}

/* Finds reasons to stop a worker. */
static void attempt_check(struct supervisor *supervisor, struct attempt *attempt, double now)
{
    attempt_refresh(supervisor, attempt);
    if (attempt->wall_deadline != 0 && now > attempt->wall_deadline && attempt->stop_reason == NULL)
        attempt->stop_reason = "time_limit";
    if (attempt->disk_limit > 0 && now >= attempt->next_disk_check) {
        attempt->next_disk_check = now + disk_check_seconds;
        if (folder_size(attempt->folder) > attempt->disk_limit && attempt->stop_reason == NULL)
            attempt->stop_reason = "disk_limit";
    }
    /* A worker that has told its end gets time to exit by itself. */
    if (attempt->last != NULL && attempt->stop_deadline <= 0)
        attempt->stop_deadline = now + supervisor->service->config->stop_seconds;
    if (attempt->last != NULL || attempt->cancel_requested || attempt->stop_reason != NULL ||
        attempt->ended)
        attempt_stop(supervisor, attempt, now);
}

/* Follows the event file; the progress is shared with those who look at the job. */
static void attempt_follow(struct supervisor *supervisor, struct attempt *attempt)
{
    (void)pthread_mutex_lock(&supervisor->mutex);
    const int64_t before = attempt->tail.offset;
    const uint64_t told = attempt->progress_count;
    attempt_read(attempt);
    if (attempt->tail.offset > before)
        (void)atomic_fetch_add(&supervisor->progress_count, 1);
    json_t *progress = attempt->progress_count == told ? NULL : json_incref(attempt->progress);
    (void)pthread_mutex_unlock(&supervisor->mutex);
    if (progress != NULL)
        feed_progress(events_feed(supervisor->service->events), attempt->id, progress);
    json_decref(progress);
}

const struct job_outcome supervisor_folder_gone = {
    .end = JOB_END_FAILED,
    .reason = "lost",
    .detail = "the job's folder is gone",
    .exit_code = -1,
    .signal_number = -1,
};

/* What a job took is what the next forecasts go by, if it ran as it was forecast: from its start,
 * as one attempt, to the end that it was submitted with. */
static void attempt_learn(struct supervisor *supervisor, const struct attempt *attempt,
                          const json_t *metrics)
{
    struct job job = {0};
    struct talus_error error = {0};
    const struct calibration_run run = {.threads = (double)attempt->threads,
                                        .busy = attempt_load_busy(attempt)};
    if (store_job_read(supervisor->service->store, attempt->id, &job, &error) == TALUS_OK &&
        job.attempt == 1 && job.steered == 0 && job.forecast != NULL) {
        json_t *forecast = json_loads(job.forecast, 0, NULL);
        calibration_learn(supervisor->service->calibration, forecast, metrics, &run);
        json_decref(forecast);
    }
    job_release(&job);
}

/* Records the end of an attempt whose lock we got. False: the store refused; try again later. */
static bool attempt_record(struct supervisor *supervisor, struct attempt *attempt, bool gone)
{
    struct job_outcome outcome = supervisor_folder_gone;
    struct talus_error error = {0};
    json_t *receipt = NULL;
    char detail[512];
    attempt_follow(supervisor, attempt);
    if (!gone)
        attempt_outcome(attempt, &outcome, &receipt, detail);
    enum talus_status status = jobs_finish(supervisor->service, attempt->id, &outcome, &error);
    if (status == TALUS_OK)
        metrics_attempt_end(supervisor->service->metrics, outcome.end);
    if (status == TALUS_OK && outcome.end == JOB_END_SUCCEEDED)
        attempt_learn(supervisor, attempt, outcome.metrics);
    json_decref(receipt);
    if (status != TALUS_OK)
        (void)fprintf(stderr, "talusd: job %s: %s\n", attempt->id, error.text);
    return status == TALUS_OK || strcmp(error.code, "not_found") == 0 ||
           strcmp(error.code, "state") == 0;
}

static void attempt_unlink(struct supervisor *supervisor, struct attempt *attempt)
{
    (void)pthread_mutex_lock(&supervisor->mutex);
    struct attempt **link = &supervisor->first;
    while (*link != attempt)
        link = &(*link)->next;
    *link = attempt->next;
    (void)pthread_mutex_unlock(&supervisor->mutex);
    attempt_destroy(attempt);
}

/* One look at an attempt. */
static void attempt_service(struct supervisor *supervisor, struct attempt *attempt, double now)
{
    attempt_follow(supervisor, attempt);
    if (attempt->pid > 0 && !attempt->ended)
        attempt->ended = executor_ended(attempt->pid, &attempt->wait_status);
    if (attempt->pid == 0 || attempt->ended) {
        int lock = event_log_lock(attempt->folder);
        bool gone = lock < 0 && errno == ENOENT;
        if (lock >= 0 || gone) {
            bool recorded = attempt_record(supervisor, attempt, gone);
            if (lock >= 0)
                (void)close(lock);
            if (recorded)
                attempt_unlink(supervisor, attempt);
            return;
        }
    }
    attempt_check(supervisor, attempt, now);
}

int64_t supervisor_threads(struct supervisor *supervisor)
{
    (void)pthread_mutex_lock(&supervisor->mutex);
    int64_t threads = attempt_load_working(supervisor->first);
    (void)pthread_mutex_unlock(&supervisor->mutex);
    return threads;
}

/* Whether nothing is expected of an attempt that would not wake the thread. */
static bool attempt_is_calm(const struct attempt *attempt)
{
    return attempt->end >= 0 && !attempt->ended && attempt->worker_started &&
           !attempt->orders_pending && !attempt->cancel_requested && attempt->stop_reason == NULL &&
           attempt->last == NULL;
}

/* Waits until it is time to look again. */
static void supervisor_wait(struct supervisor *supervisor)
{
    struct pollfd ready[] = {{.fd = supervisor->wake, .events = POLLIN},
                             {.fd = supervisor->ends, .events = POLLIN}};
    struct epoll_event ended[16];
    int milliseconds = supervisor->first == NULL ? IDLE_MILLISECONDS : CALM_MILLISECONDS;
    for (const struct attempt *attempt = supervisor->first; attempt != NULL;
         attempt = attempt->next) {
        if (!attempt_is_calm(attempt))
            milliseconds = TICK_MILLISECONDS;
    }
    if (poll(ready, 2, milliseconds) <= 0)
        return;
    if ((ready[0].revents & POLLIN) != 0)
        wakeup_clear(supervisor->wake, wakeup_name);
    if ((ready[1].revents & POLLIN) != 0)
        (void)epoll_wait(supervisor->ends, ended, sizeof ended / sizeof ended[0], 0);
}

static void *supervisor_main(void *argument)
{
    struct supervisor *supervisor = argument;
    while (!atomic_load(&supervisor->stopping)) {
        supervisor_wait(supervisor);
        double now = moment_monotonic();
        struct attempt *next;
        attempt_load_note(supervisor->first, now);
        for (struct attempt *attempt = supervisor->first; attempt != NULL; attempt = next) {
            next = attempt->next;
            attempt_service(supervisor, attempt, now);
        }
        supervisor_jobs_start(supervisor, now);
    }
    return NULL;
}

enum talus_status supervisor_start(struct supervisor *supervisor, struct talus_error *error)
{
    supervisor->started =
        pthread_create(&supervisor->thread, NULL, supervisor_main, supervisor) == 0;
    supervisor_wake(supervisor);
    return supervisor->started
               ? TALUS_OK
               : talus_error_set(error, TALUS_INTERNAL, "thread", "", "cannot start a thread");
}

void supervisor_destroy(struct supervisor *supervisor)
{
    if (supervisor == NULL)
        return;
    atomic_store(&supervisor->stopping, true);
    if (supervisor->started) {
        supervisor_wake(supervisor);
        (void)pthread_join(supervisor->thread, NULL);
    }
    while (supervisor->first != NULL)
        attempt_unlink(supervisor, supervisor->first);
    fair_share_release(&supervisor->share);
    if (supervisor->wake >= 0)
        (void)close(supervisor->wake);
    if (supervisor->ends >= 0)
        (void)close(supervisor->ends);
    (void)pthread_mutex_destroy(&supervisor->mutex);
    free(supervisor);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "supervisor.h"

#include "attempt.h"
#include "attempt_load.h"
#include "calibration.h"
#include "events.h"
#include "executor_local.h"
#include "fair_share.h"
#include "folder.h"
#include "jobs.h"
#include "moment.h"
#include "scheduler.h"
#include "service_metrics.h"

#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/pidfd.h>
#include <unistd.h>

/* Between two looks: at nothing; at workers that run; at one that begins, ends or is to end. */
enum { IDLE_MILLISECONDS = 1000, CALM_MILLISECONDS = 250, TICK_MILLISECONDS = 50 };
enum { CANDIDATES_MAX = 64 };
static const double disk_check_seconds = 0.5;
static const double spawn_retry_seconds = 1;

struct supervisor {
    struct service *service;
    pthread_t thread;
    bool started;
    atomic_bool stopping;
    int wake;              /* eventfd */
    int ends;              /* epoll over `end` of the attempts, each told once */
    pthread_mutex_t mutex; /* of the list of attempts and their progress */
    struct attempt *first;
    struct scheduler scheduler;
    struct fair_share share;
    double start_after; /* no start before (monotonic): the last one failed */
    atomic_uint_fast64_t progress_count;
    uint64_t empty_at; /* the store's commit count when nothing was queued */
};

enum talus_status supervisor_create(struct supervisor **result, struct service *service,
                                    struct talus_error *error)
{
    struct supervisor *supervisor = calloc(1, sizeof *supervisor);
    *result = supervisor;
    if (supervisor == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
    supervisor->service = service;
    supervisor->empty_at = UINT64_MAX;
    (void)pthread_mutex_init(&supervisor->mutex, NULL);
    supervisor->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    supervisor->ends = epoll_create1(EPOLL_CLOEXEC);
    if (supervisor->wake >= 0 && supervisor->ends >= 0)
        return TALUS_OK;
    if (supervisor->wake >= 0)
        fair_share_release(&supervisor->share);
    (void)close(supervisor->wake);
    free(supervisor);
    *result = NULL;
    return talus_error_set(error, TALUS_INTERNAL, "eventfd", "", "cannot make an eventfd");
}

void supervisor_wake(struct supervisor *supervisor)
{
    const uint64_t one = 1;
    if (supervisor != NULL && write(supervisor->wake, &one, sizeof one) < 0 && errno != EAGAIN)
        (void)fprintf(stderr, "talusd: cannot wake the supervisor\n");
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

/* Adds an attempt of a job that runs, with its child or (0) adopted. */
static bool attempt_add(struct supervisor *supervisor, const struct job *job, pid_t pid)
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
    if (status == TALUS_OK && !attempt_add(supervisor, &job, 0))
        status = talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
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

static const struct job_outcome folder_gone = {
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
    struct job_outcome outcome = folder_gone;
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
        if (jobs_finish(service, id, lock < 0 ? &folder_gone : &not_started, &second) != TALUS_OK)
            (void)fprintf(stderr, "talusd: job %s: %s\n", id, second.text);
    } else if (!attempt_add(supervisor, &job, pid)) {
        executor_signal(pid, SIGKILL);
        status = talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
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

int64_t supervisor_threads(struct supervisor *supervisor)
{
    (void)pthread_mutex_lock(&supervisor->mutex);
    int64_t threads = attempt_load_working(supervisor->first);
    (void)pthread_mutex_unlock(&supervisor->mutex);
    return threads;
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
    share_note(supervisor, now);
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
    return started;
}

static void jobs_start(struct supervisor *supervisor, double now)
{
    bool more = true;
    share_note(supervisor, now);
    while (more && !atomic_load(&supervisor->service->draining) && now >= supervisor->start_after &&
           threads_free(supervisor) > 0)
        more = next_start(supervisor, now);
    share_note(supervisor, now);
}

/* Seconds until a place gets free, as far as running jobs tell. */
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
    uint64_t count;
    int milliseconds = supervisor->first == NULL ? IDLE_MILLISECONDS : CALM_MILLISECONDS;
    for (const struct attempt *attempt = supervisor->first; attempt != NULL;
         attempt = attempt->next) {
        if (!attempt_is_calm(attempt))
            milliseconds = TICK_MILLISECONDS;
    }
    if (poll(ready, 2, milliseconds) <= 0)
        return;
    if ((ready[0].revents & POLLIN) != 0 && read(supervisor->wake, &count, sizeof count) < 0 &&
        errno != EAGAIN)
        (void)fprintf(stderr, "talusd: cannot read the wake-up\n");
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
        jobs_start(supervisor, now);
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
    supervisor_wake(supervisor);
    if (supervisor->started)
        (void)pthread_join(supervisor->thread, NULL);
    while (supervisor->first != NULL)
        attempt_unlink(supervisor, supervisor->first);
    fair_share_release(&supervisor->share);
    (void)close(supervisor->wake);
    (void)close(supervisor->ends);
    (void)pthread_mutex_destroy(&supervisor->mutex);
    free(supervisor);
}

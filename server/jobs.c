/* SPDX-License-Identifier: Apache-2.0 */
#include "jobs.h"

#include "base/protocol.h"
#include "event_log.h"
#include "events.h"
#include "folder.h"
#include "job_patch.h"
#include "json_text.h"
#include "studies/study_driver.h"
#include "supervisor.h"
#include "waits.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *jobs_folder(const struct service *service, const char *id)
{
    char *path = NULL;
    return asprintf(&path, "%s/jobs/%s", service->state, id) < 0 ? NULL : path;
}

/* Tells everybody who may care that a job is not what it was. */
static void job_changed(struct service *service, const char *id)
{
    waits_notify(service->waits, id);
    events_wake(service->events);
    supervisor_wake(service->supervisor);
    study_driver_wake(service->studies);
}

void jobs_states_write(struct service *service, const char *id, bool lock_held)
{
    struct talus_error error = {0};
    char *folder = jobs_folder(service, id);
    (void)pthread_mutex_lock(&service->journal);
    int lock = folder == NULL || lock_held ? -1 : event_log_lock(folder);
    const bool writable = folder != NULL && (lock_held || lock >= 0);
    if (!writable || event_log_repair(service->store, id, folder, &error) != TALUS_OK)
        atomic_store(&service->untold, true);
    if (error.status != TALUS_OK)
        (void)fprintf(stderr, "talusd: job %s: %s\n", id, error.text);
    if (lock >= 0)
        (void)close(lock);
    (void)pthread_mutex_unlock(&service->journal);
    free(folder);
}

static enum talus_status folder_fill(const char *folder, const struct job *job, const json_t *scene,
                                     struct talus_error *error)
{
    struct text line = {0};
    event_log_state_line(&line, &(struct store_transition){.number = job->transition_count,
                                                           .attempt = job->attempt,
                                                           .at = job->changed_at,
                                                           .state = "queued"});
    char *text = json_text(scene, 2);
    if (text == NULL || line.failed) {
        free(text);
        text_release(&line);
        return talus_error_memory(error);
    }
    enum talus_status status = folder_make(folder, error);
    if (status == TALUS_OK)
        status = folder_write(folder, PROTOCOL_SCENE_FILE, text, strlen(text), error);
    if (status == TALUS_OK)
        status = folder_write(folder, PROTOCOL_EVENTS_FILE, line.data, line.length, error);
    if (status == TALUS_OK)
        status = folder_sync(folder, error);
    free(text);
    text_release(&line);
    return status;
}

static enum talus_status jobs_folder_sync(const struct service *service, struct talus_error *error)
{
    char *path = folder_join(service->state, "jobs");
    enum talus_status status = path == NULL ? talus_error_memory(error) : folder_sync(path, error);
    free(path);
    return status;
}

static void folder_discard(const char *folder)
{
    struct talus_error error = {0};
    if (folder_remove(folder, &error) != TALUS_OK)
        (void)fprintf(stderr, "talusd: %s\n", error.text);
}

enum talus_status jobs_create(struct service *service, struct job *job, const json_t *scene,
                              const struct store_key *key, enum store_insert *result,
                              char existing[64], struct talus_error *error)
{
    char id[IDENTIFIER_LENGTH + 1];
    enum talus_status status = identifier_next(&service->identifiers, id, error);
    if (status == TALUS_OK)
        status = job_text_set(&job->id, id, error);
    if (status == TALUS_OK)
        status = job_enter(job, error);
    if (status != TALUS_OK)
        return status;
    job->revision = 1;
    /* Rows of a study become jobs only as places get free. */
    const struct store_limits limits = {
        .queued = (int64_t)service->config->queue_limit,
        .owner_queued = (int64_t)service->config->quota_queued,
        .owner_disk = service->config->quota_disk_bytes,
    };
    char *folder = jobs_folder(service, id);
    if (folder == NULL)
        return talus_error_memory(error);
    status = folder_fill(folder, job, scene, error);
    if (status == TALUS_OK)
        status = jobs_folder_sync(service, error);
    if (status == TALUS_OK)
        status = store_job_insert(service->store, job, key, job->study != NULL ? NULL : &limits,
                                  result, existing, error);
    if (status != TALUS_OK || *result != STORE_INSERTED)
        folder_discard(folder);
    else
        job_changed(service, id);
    free(folder);
    return status;
}

/* A change with its optional precondition. */
struct guarded_change {
    int64_t revision;
    enum talus_status (*change)(struct job *job, struct talus_error *error);
    const json_t *patch; /* instead of `change` */
};

static enum talus_status guarded_apply(struct job *job, void *context, struct talus_error *error)
{
    const struct guarded_change *guarded = context;
    if (guarded->revision >= 0 && guarded->revision != job->revision)
        return talus_error_set(error, TALUS_LIMIT, "revision", "",
                               "the job has changed: it is at revision %lld",
                               (long long)job->revision);
    return guarded->patch != NULL ? job_patch_apply(job, guarded->patch, error)
                                  : guarded->change(job, error);
}

static enum talus_status guarded(struct service *service, const char *id, int64_t revision,
                                 enum talus_status (*change)(struct job *job,
                                                             struct talus_error *error),
                                 struct job *result, struct talus_error *error)
{
    struct guarded_change context = {.revision = revision, .change = change};
    enum talus_status status =
        store_job_change(service->store, id, guarded_apply, &context, result, error);
    if (status == TALUS_OK) {
        jobs_states_write(service, id, false);
        job_changed(service, id);
    }
    return status;
}

enum talus_status jobs_cancel(struct service *service, const char *id, int64_t revision,
                              struct job *result, struct talus_error *error)
{
    return guarded(service, id, revision, job_cancel, result, error);
}

enum talus_status jobs_resume(struct service *service, const char *id, int64_t revision,
                              struct job *result, struct talus_error *error)
{
    return guarded(service, id, revision, job_resume, result, error);
}

enum talus_status jobs_orders_write(struct service *service, const char *id,
                                    struct talus_error *error)
{
    struct job job = {0};
    char *folder = jobs_folder(service, id);
    /* One at a time, so that the last one to write has the last orders. */
    (void)pthread_mutex_lock(&service->journal);
    enum talus_status status = folder == NULL ? talus_error_memory(error)
                                              : store_job_read(service->store, id, &job, error);
    if (status == TALUS_OK && job.steering != NULL)
        status = folder_replace(folder, PROTOCOL_CONTROL_FILE, job.steering, strlen(job.steering),
                                error);
    (void)pthread_mutex_unlock(&service->journal);
    job_release(&job);
    free(folder);
    return status;
}

enum talus_status jobs_patch(struct service *service, const char *id, int64_t revision,
                             const json_t *body, struct job *result, struct talus_error *error)
{
    struct guarded_change context = {.revision = revision, .patch = body};
    enum talus_status status =
        store_job_change(service->store, id, guarded_apply, &context, result, error);
    if (status == TALUS_OK)
        status = jobs_orders_write(service, id, error);
    if (status == TALUS_OK)
        job_changed(service, id);
    return status;
}

enum talus_status jobs_removal_complete(struct service *service, const char *id,
                                        struct talus_error *error)
{
    char *folder = jobs_folder(service, id);
    enum talus_status status =
        folder == NULL ? talus_error_memory(error) : folder_remove(folder, error);
    if (status == TALUS_OK)
        status = jobs_folder_sync(service, error);
    if (status == TALUS_OK)
        status = store_job_remove(service->store, id, error);
    free(folder);
    return status;
}

enum talus_status jobs_delete(struct service *service, const char *id, int64_t revision,
                              struct talus_error *error)
{
    struct guarded_change context = {.revision = revision, .change = job_mark_deleted};
    enum talus_status status =
        store_job_change(service->store, id, guarded_apply, &context, NULL, error);
    if (status != TALUS_OK)
        return status;
    job_changed(service, id);
    return jobs_removal_complete(service, id, error);
}

static enum talus_status begin_apply(struct job *job, void *context, struct talus_error *error)
{
    return job_begin(job, context, error);
}

enum talus_status jobs_begin(struct service *service, const char *id, struct job *result,
                             struct talus_error *error)
{
    enum talus_status status =
        store_job_change(service->store, id, begin_apply, service->boot, result, error);
    if (status == TALUS_OK) {
        jobs_states_write(service, id, true);
        job_changed(service, id);
    }
    return status;
}

static enum talus_status finish_apply(struct job *job, void *context, struct talus_error *error)
{
    return job_finish(job, context, error);
}

enum talus_status jobs_finish(struct service *service, const char *id,
                              const struct job_outcome *outcome, struct talus_error *error)
{
    enum talus_status status =
        store_job_change(service->store, id, finish_apply, (void *)(uintptr_t)outcome, NULL, error);
    if (status == TALUS_OK) {
        jobs_states_write(service, id, true);
        job_changed(service, id);
    }
    return status;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_life.h"

#include "events.h"
#include "jobs.h"
#include "moment.h"
#include "studies/study_driver.h"
#include "waits.h"

#include <string.h>

void study_changed(struct service *service, const char *id)
{
    waits_notify(service->waits, id);
    events_wake(service->events);
    study_driver_wake(service->studies);
}

static enum talus_status state_refused(const struct study *study, const char *wish,
                                       struct talus_error *error)
{
    return talus_error_set(error, TALUS_LIMIT, "state", "", "the study is %s and cannot be %s",
                           study_state_name((enum study_state)study->state), wish);
}

static enum talus_status finish_now(struct study *study, enum study_state state,
                                    struct talus_error *error)
{
    char now[MOMENT_TEXT_SIZE];
    moment_now_text(now);
    study->state = state;
    return job_text_set(&study->finished_at, now, error);
}

enum talus_status study_create(struct service *service, struct study *study, const json_t *rows,
                               const struct store_key *key, enum store_insert *result,
                               char existing[64], struct talus_error *error)
{
    char id[IDENTIFIER_LENGTH + 1], now[MOMENT_TEXT_SIZE];
    enum talus_status status = identifier_next(&service->identifiers, id, error);
    moment_now_text(now);
    if (status == TALUS_OK)
        status = job_text_set(&study->id, id, error);
    if (status == TALUS_OK)
        status = job_text_set(&study->created_at, now, error);
    study->state = STUDY_RUNNING;
    if (status == TALUS_OK)
        status = study_store_insert(service->store, study, rows, key, result, existing, error);
    if (status == TALUS_OK && *result == STORE_INSERTED)
        study_changed(service, id);
    return status;
}

/* A change with its optional precondition. */
struct guarded {
    int64_t revision;
    enum study_state state;
    const char *detail, *result;
    json_t *rows;
};

static enum talus_status revision_check(const struct study *study, int64_t revision,
                                        struct talus_error *error)
{
    if (revision < 0 || revision == study->revision)
        return TALUS_OK;
    return talus_error_set(error, TALUS_LIMIT, "revision", "",
                           "the study has changed: it is at revision %lld",
                           (long long)study->revision);
}

/* Changes a study and tells those who may care; *result (or NULL) gets it as it is then. */
static enum talus_status
study_alter(struct service *service, const char *id,
            enum talus_status (*apply)(struct study *study, struct study_change *change,
                                       struct talus_error *error),
            struct guarded guarded, struct study *result, struct talus_error *error)
{
    struct study_change change = {.apply = apply, .context = &guarded};
    enum talus_status status = study_store_change(service->store, id, &change, result, error);
    if (status == TALUS_OK)
        study_changed(service, id);
    return status;
}

static enum talus_status cancel_apply(struct study *study, struct study_change *change,
                                      struct talus_error *error)
{
    const struct guarded *guarded = change->context;
    enum talus_status status = revision_check(study, guarded->revision, error);
    if (status != TALUS_OK || study->state == STUDY_CANCELLED)
        return status;
    if (study->state != STUDY_RUNNING)
        return state_refused(study, "cancelled", error);
    study->cancel_requested = 1;
    change->cancel_waiting = true;
    return study_active_count(study) > 0 ? TALUS_OK : finish_now(study, STUDY_CANCELLED, error);
}

enum talus_status study_cancel(struct service *service, const char *id, int64_t revision,
                               struct study *result, struct talus_error *error)
{
    const struct guarded guarded = {.revision = revision};
    enum talus_status status = study_alter(service, id, cancel_apply, guarded, result, error);
    if (status == TALUS_OK)
        study_driver_wish(service->studies);
    return status;
}

static enum talus_status delete_apply(struct study *study, struct study_change *change,
                                      struct talus_error *error)
{
    const struct guarded *guarded = change->context;
    enum talus_status status = revision_check(study, guarded->revision, error);
    if (status != TALUS_OK)
        return status;
    /* A job of a study that has ended may have been resumed since. */
    if (study->state == STUDY_RUNNING || study_active_count(study) > 0)
        return talus_error_set(error, TALUS_LIMIT, "state", "",
                               "the study has jobs that have not ended and cannot be deleted");
    study->deleting = 1;
    return TALUS_OK;
}

enum talus_status study_removal_complete(struct service *service, const char *id,
                                         struct talus_error *error)
{
    json_t *jobs = NULL;
    size_t index;
    const json_t *job;
    enum talus_status status = study_store_jobs(service->store, id, &jobs, error);
    json_array_foreach(jobs, index, job)
    {
        if (status != TALUS_OK)
            break;
        status = jobs_removal_complete(service, json_string_value(job), error);
    }
    json_decref(jobs);
    return status == TALUS_OK ? study_store_remove(service->store, id, error) : status;
}

enum talus_status study_delete(struct service *service, const char *id, int64_t revision,
                               struct talus_error *error)
{
    const struct guarded guarded = {.revision = revision};
    enum talus_status status = study_alter(service, id, delete_apply, guarded, NULL, error);
    return status == TALUS_OK ? study_removal_complete(service, id, error) : status;
}

static enum talus_status end_apply(struct study *study, struct study_change *change,
                                   struct talus_error *error)
{
    const struct guarded *guarded = change->context;
    if (study->state != STUDY_RUNNING)
        return state_refused(study, study_state_name(guarded->state), error);
    enum talus_status status = finish_now(study, guarded->state, error);
    if (status == TALUS_OK)
        status = job_text_set(&study->detail, guarded->detail, error);
    if (status == TALUS_OK)
        status = job_text_set(&study->result, guarded->result, error);
    study->rows_expected = study->row_count;
    return status;
}

enum talus_status study_end(struct service *service, const char *id, enum study_state state,
                            const char *detail, const char *result, struct talus_error *error)
{
    const struct guarded guarded = {.state = state, .detail = detail, .result = result};
    return study_alter(service, id, end_apply, guarded, NULL, error);
}

static enum talus_status extend_apply(struct study *study, struct study_change *change,
                                      struct talus_error *error)
{
    const struct guarded *guarded = change->context;
    if (study->state != STUDY_RUNNING || study->cancel_requested)
        return state_refused(study, "extended", error);
    change->rows = guarded->rows;
    return TALUS_OK;
}

enum talus_status study_extend(struct service *service, const char *id, json_t *rows,
                               struct talus_error *error)
{
    const struct guarded guarded = {.rows = rows};
    return study_alter(service, id, extend_apply, guarded, NULL, error);
}

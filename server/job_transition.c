/* SPDX-License-Identifier: Apache-2.0 */
#include "job.h"
#include "moment.h"

#include <string.h>

static enum talus_status state_refused(const struct job *job, const char *wish,
                                       struct talus_error *error)
{
    return talus_error_set(error, TALUS_LIMIT, "state", "", "the job is %s and cannot be %s",
                           job_state_name((enum job_state)job->state), wish);
}

static enum talus_status state_set(struct job *job, enum job_state state, const char *reason,
                                   const char *detail, struct talus_error *error)
{
    char now[MOMENT_TEXT_SIZE];
    moment_now_text(now);
    enum talus_status status = job_text_set(&job->reason, reason, error);
    if (status == TALUS_OK)
        status = job_text_set(&job->detail, detail, error);
    if (status == TALUS_OK)
        status = job_text_set(&job->changed_at, now, error);
    if (status == TALUS_OK)
        status = job_text_set(&job->finished_at, job_state_final(state) ? now : NULL, error);
    if (status == TALUS_OK && state == JOB_RUNNING && job->started_at == NULL)
        status = job_text_set(&job->started_at, now, error);
    if (status == TALUS_OK && job->created_at == NULL)
        status = job_text_set(&job->created_at, now, error);
    job->state = state;
    job->transition_count++;
    return status;
}

/* The array of attempts with one added, or with the last one completed. */
static enum talus_status attempts_change(struct job *job, bool add, json_t *members,
                                         struct talus_error *error)
{
    json_t *attempts = job->attempts == NULL ? json_array() : json_loads(job->attempts, 0, NULL);
    bool good = attempts != NULL && members != NULL;
    if (good && add)
        good = json_array_append(attempts, members) == 0;
    else if (good)
        good = json_object_update(json_array_get(attempts, json_array_size(attempts) - 1),
                                  members) == 0;
    enum talus_status status = good ? job_json_set(&job->attempts, attempts, error)
                                    : talus_error_set(error, TALUS_INTERNAL, "attempts", "",
                                                      "the list of attempts is bad");
    json_decref(attempts);
    json_decref(members);
    return status;
}

enum talus_status job_enter(struct job *job, struct talus_error *error)
{
    return state_set(job, JOB_QUEUED, NULL, NULL, error);
}

enum talus_status job_begin(struct job *job, const char *boot, struct talus_error *error)
{
    if (job->state != JOB_QUEUED || job->deleting)
        return state_refused(job, "started", error);
    job->attempt++;
    job->attempt_started = moment_now();
    enum talus_status status = state_set(job, JOB_RUNNING, NULL, NULL, error);
    if (status == TALUS_OK)
        status = job_text_set(&job->boot, boot, error);
    if (status == TALUS_OK)
        status = attempts_change(job, true,
                                 json_pack("{s:I, s:s, s:I}", "number", (json_int_t)job->attempt,
                                           "started_at", job->changed_at, "threads",
                                           (json_int_t)job->threads),
                                 error);
    return status;
}

static enum talus_status attempt_close(struct job *job, const struct job_outcome *outcome,
                                       struct talus_error *error)
{
    static const char *const names[] = {
        [JOB_END_SUCCEEDED] = "succeeded", [JOB_END_FAILED] = "failed",
        [JOB_END_CANCELLED] = "cancelled", [JOB_END_CRASHED] = "crashed",
        [JOB_END_LOST] = "lost",
    };
    char now[MOMENT_TEXT_SIZE];
    moment_now_text(now);
    double elapsed = moment_now() - job->attempt_started;
    job->wall_used += elapsed > 0 ? elapsed : 0;
    json_t *members =
        json_pack("{s:s, s:s, s:s*, s:s*}", "finished_at", now, "outcome", names[outcome->end],
                  "reason", outcome->reason, "detail", outcome->detail);
    if (outcome->exit_code >= 0)
        (void)json_object_set_new(members, "exit_code", json_integer(outcome->exit_code));
    if (outcome->signal_number >= 0)
        (void)json_object_set_new(members, "signal", json_integer(outcome->signal_number));
    enum talus_status status = attempts_change(job, false, members, error);
    if (status == TALUS_OK && outcome->metrics != NULL)
        status = job_json_set(&job->metrics, outcome->metrics, error);
    if (status == TALUS_OK && outcome->receipt != NULL)
        status = job_json_set(&job->receipt, outcome->receipt, error);
    if (status == TALUS_OK && outcome->end == JOB_END_SUCCEEDED)
        status = job_text_set(&job->build,
                              json_string_value(json_object_get(outcome->receipt, "build")), error);
    if (status == TALUS_OK && outcome->progress != NULL)
        status = job_json_set(&job->progress, outcome->progress, error);
    return status;
}

enum talus_status job_finish(struct job *job, const struct job_outcome *outcome,
                             struct talus_error *error)
{
    if (job->state != JOB_RUNNING)
        return state_refused(job, "finished", error);
    enum talus_status status = attempt_close(job, outcome, error);
    if (status != TALUS_OK)
        return status;
    bool again = outcome->end == JOB_END_LOST || outcome->end == JOB_END_CRASHED;
    if (outcome->end == JOB_END_CRASHED)
        job->crash_count++;
    if (again && job->cancel_requested)
        return state_set(job, JOB_CANCELLED, NULL, NULL, error);
    if (outcome->end == JOB_END_LOST ||
        (outcome->end == JOB_END_CRASHED && job->crash_count <= job->retries))
        return state_set(job, JOB_QUEUED, outcome->reason, outcome->detail, error);
    switch (outcome->end) {
    case JOB_END_SUCCEEDED:
        return state_set(job, JOB_SUCCEEDED, NULL, NULL, error);
    case JOB_END_CANCELLED:
        return state_set(job, JOB_CANCELLED, NULL, outcome->detail, error);
    default:
        return state_set(job, JOB_FAILED, outcome->reason, outcome->detail, error);
    }
}

enum talus_status job_cancel(struct job *job, struct talus_error *error)
{
    switch ((enum job_state)job->state) {
    case JOB_QUEUED:
        return state_set(job, JOB_CANCELLED, NULL, NULL, error);
    case JOB_RUNNING:
        job->cancel_requested = 1;
        return TALUS_OK;
    case JOB_CANCELLED:
        return TALUS_OK;
    default:
        return state_refused(job, "cancelled", error);
    }
}

enum talus_status job_resume(struct job *job, struct talus_error *error)
{
    if ((job->state != JOB_FAILED && job->state != JOB_CANCELLED) || job->deleting)
        return state_refused(job, "resumed", error);
    job->cancel_requested = 0;
    job->crash_count = 0;
    enum talus_status status = job_text_set(&job->metrics, NULL, error);
    if (status == TALUS_OK)
        status = job_text_set(&job->receipt, NULL, error);
    return status == TALUS_OK ? state_set(job, JOB_QUEUED, NULL, NULL, error) : status;
}

enum talus_status job_mark_deleted(struct job *job, struct talus_error *error)
{
    if (!job_state_final((enum job_state)job->state))
        return state_refused(job, "deleted", error);
    job->deleting = 1;
    return TALUS_OK;
}

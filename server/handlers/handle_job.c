/* SPDX-License-Identifier: Apache-2.0 */
/* GET, PATCH, DELETE, cancel and resume of one job. */
#include "admission.h"
#include "body.h"
#include "job_cache.h"
#include "job_patch.h"
#include "job_reply.h"
#include "jobs.h"
#include "request.h"
#include "revision.h"
#include "schemas.h"
#include "service.h"
#include "supervisor.h"
#include "waits.h"

#include <stdlib.h>
#include <string.h>

const struct operation operation_job = {
    .summary = "A job as it is",
    .path = operation_job_path,
    .query = revision_wait_query,
    .headers = revision_known_headers,
    .responses =
        (const struct response[]){
            {.status = 200,
             .type = "application/json",
             .schema = &schema_job,
             .headers = revision_headers,
             .meaning = "the job; its ETag changes with everything but progress"},
            REVISION_UNCHANGED,
            RESPONSE_END},
};

enum handled handle_job(struct request *request)
{
    struct service *service = request->service;
    revision_wait_begin(request);
    for (;;) {
        struct job job;
        uint64_t mark = waits_mark(service->waits);
        const struct job_cache_mark read_at = job_cache_mark(service);
        if (!request_job(request, &job))
            return HANDLED;
        bool due = revision_due(request, job.revision, job_state_final((enum job_state)job.state));
        if (due && !revision_known(request, job.revision))
            job_cache_reply(request, &job, read_at);
        job_release(&job);
        if (due)
            return HANDLED;
        if (waits_park(service->waits, request, mark))
            return HANDLED_PARKED;
    }
}

static enum handled
job_control(struct request *request,
            enum talus_status (*control)(struct service *service, const char *id, int64_t revision,
                                         struct job *result, struct talus_error *error))
{
    int64_t revision;
    struct job job = {0};
    struct talus_error error = {0};
    if (!body_absent(request) || !job_revision_read(request, &revision, NULL))
        return HANDLED;
    if (control(request->service, request->segment, revision, &job, &error) == TALUS_OK)
        job_reply(request, MHD_HTTP_OK, &job);
    else
        reply_error(&request->reply, request->raw, &error);
    job_release(&job);
    return HANDLED;
}

static const struct response job_response[] = {{.status = 200,
                                                .type = "application/json",
                                                .schema = &schema_job,
                                                .headers = revision_headers,
                                                .meaning = "the job as it is now"},
                                               RESPONSE_END};

const struct operation operation_job_cancel = {
    .summary = "Cancels a job: a queued one at once, a running one as soon as its processes end",
    .path = operation_job_path,
    .headers = revision_match_headers,
    .responses = job_response,
    .problems = revision_problems,
};

enum handled handle_job_cancel(struct request *request)
{
    return job_control(request, jobs_cancel);
}

const struct operation operation_job_resume = {
    .summary = "Lets a failed or cancelled job go on from its last checkpoint, as a new attempt",
    .path = operation_job_path,
    .headers = revision_match_headers,
    .responses = job_response,
    .problems = revision_problems,
};

enum handled handle_job_resume(struct request *request)
{
    return job_control(request, jobs_resume);
}

const struct operation operation_job_delete = {
    .summary = "Deletes a finished job and all its files",
    .path = operation_job_path,
    .headers = revision_match_headers,
    .responses = (const struct response[]){{.status = 204, .meaning = "it is gone"}, RESPONSE_END},
    .problems = revision_problems,
};

enum handled handle_job_delete(struct request *request)
{
    int64_t revision;
    struct talus_error error = {0};
    if (!body_absent(request) || !job_revision_read(request, &revision, NULL))
        return HANDLED;
    if (jobs_delete(request->service, request->segment, revision, &error) == TALUS_OK)
        reply_empty(&request->reply, MHD_HTTP_NO_CONTENT);
    else
        reply_error(&request->reply, request->raw, &error);
    return HANDLED;
}

/* The simulated time that a job has reached [s], as far as it has told. */
static double time_reached(struct service *service, const struct job *job)
{
    json_t *progress = supervisor_progress(service->supervisor, job->id);
    double time = json_number_value(json_object_get(progress, "time"));
    json_decref(progress);
    return time;
}

/* Applies a body whose form is right. */
static void job_change(struct request *request, const json_t *body, int64_t revision)
{
    struct talus_error error = {0};
    struct job job = {0};
    if (jobs_patch(request->service, request->segment, revision, body, &job, &error) == TALUS_OK)
        job_reply(request, MHD_HTTP_OK, &job);
    else
        reply_error(&request->reply, request->raw, &error);
    job_release(&job);
}

const struct operation operation_job_patch = {
    .summary = "Changes priority, labels and limits of a job, and steers a running one",
    .path = operation_job_path,
    .headers = revision_match_headers,
    .body = &schema_job_patch,
    .responses = job_response,
    .problems = revision_problems,
};

enum handled handle_job_patch(struct request *request)
{
    int64_t revision;
    struct job job = {0};
    if (!job_revision_read(request, &revision, &job))
        return HANDLED;
    json_t *body = body_json(request), *errors = json_array();
    if (body != NULL)
        job_patch_check(body, &job, time_reached(request->service, &job), errors);
    if (json_array_size(errors) > 0)
        admission_refused(request, errors);
    else if (body != NULL && job_patch_empty(body))
        job_reply(request, MHD_HTTP_OK, &job);
    else if (body != NULL)
        job_change(request, body, revision);
    json_decref(errors);
    json_decref(body);
    job_release(&job);
    return HANDLED;
}

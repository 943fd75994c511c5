/* SPDX-License-Identifier: Apache-2.0 */
/* GET, DELETE, cancel and resume of one job. */
#include "byte_range.h"
#include "jobs.h"
#include "moment.h"
#include "request.h"
#include "waits.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WAIT_SECONDS_MAX = 60 };

static void etag_print(const struct job *job, char etag[32])
{
    (void)snprintf(etag, 32, "\"%lld\"", (long long)job->revision);
}

static void reply_job(struct request *request, const struct job *job)
{
    char etag[32];
    etag_print(job, etag);
    reply_json(&request->reply, MHD_HTTP_OK, jobs_json(request->service, job));
    reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
}

/* Whether the answer is due now; else the request is to wait. */
static bool answer_due(const struct request *request, const struct job *job, double wait,
                       const char *known)
{
    char etag[32];
    if (wait <= 0 || request->expired)
        return true;
    if (known == NULL)
        return job_state_final((enum job_state)job->state);
    etag_print(job, etag);
    return !etag_listed(known, etag, true);
}

enum handled handle_job(struct request *request)
{
    static const char *const allowed[] = {"wait", NULL};
    struct service *service = request->service;
    double wait;
    if (!request_query_check(request, allowed) ||
        !request_query_number(request, "wait", 0, WAIT_SECONDS_MAX, 0, &wait))
        return HANDLED;
    const char *known = request_header(request, MHD_HTTP_HEADER_IF_NONE_MATCH);
    if (wait > 0 && request->deadline <= 0)
        request->deadline = moment_monotonic() + wait;
    for (;;) {
        struct job job;
        uint64_t mark = waits_mark(service->waits);
        if (!request_job(request, &job))
            return HANDLED;
        if (answer_due(request, &job, wait, known)) {
            char etag[32];
            etag_print(&job, etag);
            if (known != NULL && etag_listed(known, etag, true)) {
                reply_empty(&request->reply, MHD_HTTP_NOT_MODIFIED);
                reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
            } else {
                reply_job(request, &job);
            }
            job_release(&job);
            return HANDLED;
        }
        job_release(&job);
        if (waits_park(service->waits, request, mark))
            return HANDLED_PARKED;
    }
}

/* The revision that If-Match asks for, -1 for any. False: the reply is made. */
static bool revision_read(struct request *request, int64_t *revision)
{
    const char *header = request_header(request, MHD_HTTP_HEADER_IF_MATCH);
    struct job job;
    *revision = -1;
    if (!request_job(request, &job))
        return false;
    char etag[32];
    etag_print(&job, etag);
    bool matches = header == NULL || etag_listed(header, etag, false);
    if (header != NULL && matches && strchr(header, '*') == NULL)
        *revision = job.revision;
    if (!matches)
        reply_problem(&request->reply, MHD_HTTP_PRECONDITION_FAILED, "revision", request->raw, NULL,
                      "the job has changed: it is at revision %lld", (long long)job.revision);
    job_release(&job);
    return matches;
}

/* These calls take no body but an empty object. False: the reply is made. */
static bool body_empty(struct request *request)
{
    static const char *const no_query[] = {NULL};
    if (!request_query_check(request, no_query))
        return false;
    if (request->body.length == 0 || strcmp(request->body.data, "{}") == 0)
        return true;
    json_t *errors = json_array();
    issue_add(errors, "", "unknown_key", NULL, NULL, "this call takes no body");
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "invalid", request->raw, errors,
                  "this call takes no body");
    return false;
}

static enum handled
job_control(struct request *request,
            enum talus_status (*control)(struct service *service, const char *id, int64_t revision,
                                         struct job *result, struct talus_error *error))
{
    int64_t revision;
    struct job job = {0};
    struct talus_error error = {0};
    if (!body_empty(request) || !revision_read(request, &revision))
        return HANDLED;
    if (control(request->service, request->segment, revision, &job, &error) == TALUS_OK)
        reply_job(request, &job);
    else
        reply_error(&request->reply, request->raw, &error);
    job_release(&job);
    return HANDLED;
}

enum handled handle_job_cancel(struct request *request)
{
    return job_control(request, jobs_cancel);
}

enum handled handle_job_resume(struct request *request)
{
    return job_control(request, jobs_resume);
}

enum handled handle_job_delete(struct request *request)
{
    int64_t revision;
    struct talus_error error = {0};
    if (!body_empty(request) || !revision_read(request, &revision))
        return HANDLED;
    if (jobs_delete(request->service, request->segment, revision, &error) == TALUS_OK)
        reply_empty(&request->reply, MHD_HTTP_NO_CONTENT);
    else
        reply_error(&request->reply, request->raw, &error);
    return HANDLED;
}

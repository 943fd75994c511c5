/* SPDX-License-Identifier: Apache-2.0 */
#include "job_reply.h"

#include "byte_range.h"
#include "jobs.h"

#include <stdio.h>
#include <string.h>

void job_etag(const struct job *job, char etag[JOB_ETAG_SIZE])
{
    (void)snprintf(etag, JOB_ETAG_SIZE, "\"%lld\"", (long long)job->revision);
}

void job_reply(struct request *request, unsigned int status, const struct job *job)
{
    char etag[JOB_ETAG_SIZE];
    struct text text = {0};
    job_etag(job, etag);
    jobs_text_add(&text, request->service, job, NULL);
    reply_json_text(&request->reply, status, &text);
    reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
}

bool job_revision_read(struct request *request, int64_t *revision, struct job *result)
{
    const char *header = request_header(request, MHD_HTTP_HEADER_IF_MATCH);
    char etag[JOB_ETAG_SIZE];
    struct job job;
    *revision = -1;
    if (!request_job(request, &job))
        return false;
    job_etag(&job, etag);
    bool matches = header == NULL || etag_listed(header, etag, false);
    if (header != NULL && matches && strchr(header, '*') == NULL)
        *revision = job.revision;
    if (!matches)
        reply_problem(&request->reply, MHD_HTTP_PRECONDITION_FAILED, "revision", request->raw, NULL,
                      "the job has changed: it is at revision %lld", (long long)job.revision);
    if (matches && result != NULL)
        *result = job;
    else
        job_release(&job);
    return matches;
}

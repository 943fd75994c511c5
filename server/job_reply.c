/* SPDX-License-Identifier: Apache-2.0 */
#include "job_reply.h"

#include "jobs.h"
#include "revision.h"

void job_reply(struct request *request, unsigned int status, const struct job *job)
{
    char etag[REVISION_ETAG_SIZE];
    struct text text = {0};
    revision_etag(job->revision, etag);
    jobs_text_add(&text, request->service, job, NULL);
    reply_json_text(&request->reply, status, &text);
    reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
}

bool job_revision_read(struct request *request, int64_t *revision, struct job *result)
{
    struct job job;
    *revision = -1;
    if (!request_job(request, &job))
        return false;
    bool matches = revision_wanted(request, "job", job.revision, revision);
    if (matches && result != NULL)
        *result = job;
    else
        job_release(&job);
    return matches;
}

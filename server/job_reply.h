/* SPDX-License-Identifier: Apache-2.0 */
/* A job as an answer, and the revision that a request insists on. */
#ifndef TALUS_JOB_REPLY_H
#define TALUS_JOB_REPLY_H

#include "request.h"

/* The job with its ETag. */
void job_reply(struct request *request, unsigned int status, const struct job *job);
/* Reads the job that the path names and the revision that If-Match asks for, -1 for any; *job (or
 * NULL) is to be released. False: the reply is made. */
bool job_revision_read(struct request *request, int64_t *revision, struct job *job);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Answers to status polls, kept as long as they are true. Many clients ask again and again for jobs
 * that have not changed; a kept answer needs neither the store nor another thread. */
#ifndef TALUS_JOB_CACHE_H
#define TALUS_JOB_CACHE_H

#include "job.h"
#include "request.h"
#include "talus/status.h"

struct job_cache;

/* What an answer was made from: it is true while these counts are the same. */
struct job_cache_mark {
    uint64_t commits;  /* of the store */
    uint64_t progress; /* of the supervisor; matters for running jobs */
};

TALUS_MUST_CHECK enum talus_status job_cache_create(struct job_cache **cache,
                                                    struct talus_error *error);
/* Every response must have been destroyed. NULL is fine. */
void job_cache_destroy(struct job_cache *cache);
/* The counts by now: before a job is read. */
struct job_cache_mark job_cache_mark(const struct service *service);
/* Answers with a job that was read behind `mark`, and keeps the answer. Without memory there is no
 * reply. */
void job_cache_reply(struct request *request, const struct job *job, struct job_cache_mark mark);
/* Answers a GET of a job at once if a true answer is kept. False: nothing was done. */
bool job_cache_answer(struct request *request);

#endif

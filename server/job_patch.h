/* SPDX-License-Identifier: Apache-2.0 */
/* The body of a PATCH of a job: a merge patch (RFC 7396) of its priority, labels and limits, and
 * orders to a running one. */
#ifndef TALUS_JOB_PATCH_H
#define TALUS_JOB_PATCH_H

#include "job.h"

#include <jansson.h>

/* Adds every mistake of `body` to *errors; `time` is the simulated time that the job has reached
 * [s], before which it cannot end. */
void job_patch_check(const json_t *body, const struct job *job, double time, json_t *errors);
/* Applies a body without mistakes. TALUS_LIMIT, code "state": the job has ended, or there are
 * orders and it does not run; "labels": it would have too many. */
TALUS_MUST_CHECK enum talus_status job_patch_apply(struct job *job, const json_t *body,
                                                   struct talus_error *error);
/* Whether a body without mistakes asks for nothing. */
bool job_patch_empty(const json_t *body);

#endif

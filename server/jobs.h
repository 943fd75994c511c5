/* SPDX-License-Identifier: Apache-2.0 */
/* What happens to jobs: folder, store, event log and whoever waits, in the order that survives a
 * kill at any instant. Folder and scene first, then the row; a removal marks the row, removes the
 * folder, removes the row. */
#ifndef TALUS_JOBS_H
#define TALUS_JOBS_H

#include "job.h"
#include "service.h"
#include "text.h"

#include <jansson.h>

/* The folder of a job; free() it; NULL without memory. */
char *jobs_folder(const struct service *service, const char *id);
/* Appends the job as clients see it; of its members only those in the comma-separated `fields`
 * (NULL: all). */
void jobs_text_add(struct text *text, struct service *service, const struct job *job,
                   const char *fields);

/* Makes a job from what `job` already holds (its id and times are set here) and its effective
 * scene. *result tells whether the key was known; then `existing` is that job. */
TALUS_MUST_CHECK enum talus_status jobs_create(struct service *service, struct job *job,
                                               const json_t *scene, const struct store_key *key,
                                               enum store_insert *result, char existing[64],
                                               struct talus_error *error);
/* These refuse with code "revision" when `revision` is not negative and not the job's. *result is
 * the job afterwards; release it. */
TALUS_MUST_CHECK enum talus_status jobs_cancel(struct service *service, const char *id,
                                               int64_t revision, struct job *result,
                                               struct talus_error *error);
TALUS_MUST_CHECK enum talus_status jobs_resume(struct service *service, const char *id,
                                               int64_t revision, struct job *result,
                                               struct talus_error *error);
TALUS_MUST_CHECK enum talus_status jobs_delete(struct service *service, const char *id,
                                               int64_t revision, struct talus_error *error);
/* Changes a job as a body without mistakes says (job_patch.h). Orders are in the store and in
 * control.json when this returns; the supervisor passes them on. */
TALUS_MUST_CHECK enum talus_status jobs_patch(struct service *service, const char *id,
                                              int64_t revision, const json_t *body,
                                              struct job *result, struct talus_error *error);
/* Writes control.json as the store has it, if there are orders. */
TALUS_MUST_CHECK enum talus_status jobs_orders_write(struct service *service, const char *id,
                                                     struct talus_error *error);
/* For the supervisor, which holds the job's lock: a new attempt begins, and ends. */
TALUS_MUST_CHECK enum talus_status jobs_begin(struct service *service, const char *id,
                                              struct job *result, struct talus_error *error);
TALUS_MUST_CHECK enum talus_status jobs_finish(struct service *service, const char *id,
                                               const struct job_outcome *outcome,
                                               struct talus_error *error);
/* Writes the state lines that the event file lacks, unless a worker holds the lock: then whoever
 * takes the lock after it does. `lock_held`: the caller holds it. */
void jobs_states_write(struct service *service, const char *id, bool lock_held);
/* The last two of the three steps of a removal. */
TALUS_MUST_CHECK enum talus_status jobs_removal_complete(struct service *service, const char *id,
                                                         struct talus_error *error);

#endif

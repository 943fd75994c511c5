/* SPDX-License-Identifier: Apache-2.0 */
/* What happens to studies, in the order that survives a kill at any instant: as jobs.h for jobs. */
#ifndef TALUS_STUDY_LIFE_H
#define TALUS_STUDY_LIFE_H

#include "service.h"
#include "studies/study_store.h"

/* Makes a study of what `study` already holds (its id and times are set here) and its rows. *result
 * tells whether the key was known; then `existing` is that study. */
TALUS_MUST_CHECK enum talus_status study_create(struct service *service, struct study *study,
                                                const json_t *rows, const struct store_key *key,
                                                enum store_insert *result, char existing[64],
                                                struct talus_error *error);
/* Cancels what waits at once; what is queued or runs is stopped, and the study is `cancelled` when
 * that is over. Refuses with code "revision" when `revision` is not negative and not the study's.
 * *result is the study afterwards; release it. */
TALUS_MUST_CHECK enum talus_status study_cancel(struct service *service, const char *id,
                                                int64_t revision, struct study *result,
                                                struct talus_error *error);
/* Removes a study that has ended, with its own jobs. */
TALUS_MUST_CHECK enum talus_status study_delete(struct service *service, const char *id,
                                                int64_t revision, struct talus_error *error);
/* All but the first step of a removal. */
TALUS_MUST_CHECK enum talus_status study_removal_complete(struct service *service, const char *id,
                                                          struct talus_error *error);
/* The study ends. TALUS_LIMIT, code "state", if it does not run. Texts are borrowed, NULL: none. */
TALUS_MUST_CHECK enum talus_status study_end(struct service *service, const char *id,
                                             enum study_state state, const char *detail,
                                             const char *result, struct talus_error *error);
/* Adds rows (struct study_plan) to a study that runs and is not to be cancelled. */
TALUS_MUST_CHECK enum talus_status study_extend(struct service *service, const char *id,
                                                json_t *rows, struct talus_error *error);
/* Tells everybody who may care that a study is not what it was. */
void study_changed(struct service *service, const char *id);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* The thread that starts queued jobs while threads are free, follows their workers, stops them when
 * they must stop, and records how they ended. */
#ifndef TALUS_SUPERVISOR_H
#define TALUS_SUPERVISOR_H

#include "service.h"

#include <jansson.h>

struct supervisor;

/* *service is borrowed. Nothing starts before supervisor_start. */
TALUS_MUST_CHECK enum talus_status supervisor_create(struct supervisor **supervisor,
                                                     struct service *service,
                                                     struct talus_error *error);
/* Takes over a job that a dead daemon left running. Before supervisor_start. */
TALUS_MUST_CHECK enum talus_status supervisor_adopt(struct supervisor *supervisor, const char *id,
                                                    struct talus_error *error);
TALUS_MUST_CHECK enum talus_status supervisor_start(struct supervisor *supervisor,
                                                    struct talus_error *error);
/* Ends the thread and leaves the workers running. NULL is fine. */
void supervisor_destroy(struct supervisor *supervisor);
/* Looks at the jobs now. NULL is fine. */
void supervisor_wake(struct supervisor *supervisor);
/* Threads of the jobs that have work to do now. */
int64_t supervisor_threads(struct supervisor *supervisor);
/* The last progress of a running job, or NULL; new reference. */
json_t *supervisor_progress(struct supervisor *supervisor, const char *id);
/* Grows when the progress of any job has changed. */
uint64_t supervisor_progress_count(const struct supervisor *supervisor);

/* Seconds after which a place in the queue may be free, as far as running jobs tell; at least 1, at
 * most 60. */
double supervisor_patience(struct supervisor *supervisor);

#endif

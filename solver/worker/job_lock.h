/* SPDX-License-Identifier: Apache-2.0 */
/* The right to run in a job's folder: flock on job.lock, inherited from whoever starts the worker
 * (TALUS_LOCK_FD) or taken by the worker itself. It ends with the process, however that ends. */
#ifndef TALUS_JOB_LOCK_H
#define TALUS_JOB_LOCK_H

#include "talus/status.h"

#include <stdbool.h>

struct job_lock {
    int descriptor; /* below 0: none */
    bool inherited;
};

/* TALUS_IO with code "locked" when another process holds the folder. */
TALUS_MUST_CHECK enum talus_status job_lock_take(struct job_lock *lock, const char *folder,
                                                 struct talus_error *error);
void job_lock_release(struct job_lock *lock);

#endif

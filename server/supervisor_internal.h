/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the files of the supervisor. */
#ifndef TALUS_SUPERVISOR_INTERNAL_H
#define TALUS_SUPERVISOR_INTERNAL_H

#include "attempt.h"
#include "fair_share.h"
#include "scheduler.h"
#include "supervisor.h"

#include <pthread.h>
#include <stdatomic.h>

struct supervisor {
    struct service *service;
    pthread_t thread;
    bool started;
    atomic_bool stopping;
    int wake;              /* wakeup.h */
    int ends;              /* epoll over `end` of the attempts, each told once */
    pthread_mutex_t mutex; /* of the list of attempts and their progress */
    struct attempt *first;
    struct scheduler scheduler;
    struct fair_share share;
    double start_after; /* no start before (monotonic): the last one failed */
    atomic_uint_fast64_t progress_count;
    uint64_t empty_at; /* the store's commit count when nothing was queued */
};

/* How an attempt ends whose folder is gone. */
extern const struct job_outcome supervisor_folder_gone;

/* Adds an attempt of a job that runs, with its child or (0) adopted. False without memory. */
bool supervisor_attempt_add(struct supervisor *supervisor, const struct job *job, pid_t pid);
/* Starts queued jobs while threads are free (supervisor_queue.c). */
void supervisor_jobs_start(struct supervisor *supervisor, double now);

#endif

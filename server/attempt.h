/* SPDX-License-Identifier: Apache-2.0 */
/* One attempt of a job under way: what is known of its worker, and how it ended. */
#ifndef TALUS_ATTEMPT_H
#define TALUS_ATTEMPT_H

#include "event_log.h"
#include "job.h"

#include <jansson.h>
#include <stdbool.h>
#include <sys/types.h>

/* Owns texts, JSON and the tail. */
struct attempt {
    char *id, *folder, *owner;
    int64_t number, threads, memory_limit, disk_limit;
    double wall_begin;    /* when the job would have begun without pauses (monotonic) */
    double wall_deadline; /* when limits.wall_seconds is used up (monotonic), 0: never */
    int64_t revision;     /* of the job when it was last looked at */
    char *orders;         /* of the job as they were then, NULL: none */
    bool orders_pending;  /* the worker has not been told yet */
    bool other_boot;      /* it was started before the machine was */
    pid_t pid;            /* 0: adopted, known by its lock only */
    int end;              /* descriptor that becomes readable when the child ends; -1: none */
    bool ended;           /* our child has ended with wait_status */
    int wait_status;
    bool cancel_requested;
    uint64_t commit_count;   /* of the store when that was looked up */
    const char *stop_reason; /* why we stopped it ("time_limit", "disk_limit"), or NULL */
    double stop_deadline;    /* when SIGTERM becomes SIGKILL (monotonic); 0: not stopped */
    double next_disk_check;
    double watched_until, watched_seconds; /* attempt_load.h (monotonic; [s]) */
    double busy_seconds;                   /* of threads of other jobs meanwhile */
    struct event_tail tail;
    bool worker_started; /* its `started` line is there */
    json_t *progress;    /* the last one */
    uint64_t progress_count;
    json_t *last; /* `finished` or `failed` */
    struct attempt *next;
};

/* A new attempt of a job whose row says `running`. NULL without memory. */
struct attempt *attempt_create(const struct job *job, const char *folder, const char *boot);
void attempt_destroy(struct attempt *attempt);
/* Takes over what may change while it runs: cancellation, limits, orders. Returns whether its
 * limits of memory or disk are others now. */
bool attempt_update(struct attempt *attempt, const struct job *job);
/* Follows the event file. */
void attempt_read(struct attempt *attempt);
/* How it ended, once its processes are gone. *outcome borrows from the attempt and from *receipt
 * (new reference or NULL) and detail. */
void attempt_outcome(const struct attempt *attempt, struct job_outcome *outcome, json_t **receipt,
                     char detail[512]);

#endif

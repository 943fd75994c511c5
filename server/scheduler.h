/* SPDX-License-Identifier: Apache-2.0 */
/* Which queued job starts next. Order is priority, then the owner who has least (fair_share.h),
 * then age. A job that needs more threads than are free lets smaller ones past for a while; after
 * that, nothing of its priority or below passes it, whosever it is, so it is not starved. */
#ifndef TALUS_SCHEDULER_H
#define TALUS_SCHEDULER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SCHEDULER_ID_SIZE = 64 };

struct scheduler_candidate {
    char id[SCHEDULER_ID_SIZE], owner[SCHEDULER_ID_SIZE];
    int64_t threads, priority;
    int64_t owner_threads; /* of the owner's jobs that run */
    double owner_use;      /* [thread seconds] of late */
};

/* A job that was at the head of the queue and did not fit, and since when. A zeroed struct is
 * empty.
 */
struct scheduler {
    char blocked[SCHEDULER_ID_SIZE];
    double blocked_since; /* monotonic [s] */
};

/* How long smaller jobs may pass [s]. */
extern const double scheduler_patience;

/* The index of the job to start among `candidates` in queue order, or `count` if none may start
 * now. */
size_t scheduler_pick(struct scheduler *scheduler, const struct scheduler_candidate *candidates,
                      size_t count, int64_t free_threads, double now);

#endif

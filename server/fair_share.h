/* SPDX-License-Identifier: Apache-2.0 */
/* Who has had how much of the machine: the processor time of each owner's jobs, which fades. */
#ifndef TALUS_FAIR_SHARE_H
#define TALUS_FAIR_SHARE_H

#include "scheduler.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Time in which half of what was used is forgotten [s]. */
extern const double fair_share_half_life;

struct fair_owner;

/* A zeroed struct knows nobody. */
struct fair_share {
    struct fair_owner *first;
    double now; /* time of the last note (monotonic [s]), 0: none yet */
};

void fair_share_release(struct fair_share *share);
/* Begins a look at what runs now: what was used until now fades, and nobody runs anything. */
void fair_share_begin(struct fair_share *share, double now);
/* A job of an owner runs with so many threads, since the look before at least. False without
 * memory. */
bool fair_share_note(struct fair_share *share, const char *owner, int64_t threads);
/* Jobs of an owner that run. */
int64_t fair_share_jobs(const struct fair_share *share, const char *owner);
/* Puts candidates into the order in which they are to start: priority; then the owner with the
 * least threads that run, then the one that used least; then age. */
void fair_share_order(const struct fair_share *share, struct scheduler_candidate *candidates,
                      size_t count);

#endif

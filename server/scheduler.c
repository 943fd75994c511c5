/* SPDX-License-Identifier: Apache-2.0 */
#include "scheduler.h"

#include <stdio.h>
#include <string.h>

const double scheduler_patience = 10;

/* Where the job that waits for threads stands, `count` if it is gone. */
static size_t blocked_find(const struct scheduler *scheduler,
                           const struct scheduler_candidate *candidates, size_t count)
{
    size_t index = 0;
    while (index < count && strcmp(candidates[index].id, scheduler->blocked) != 0)
        index++;
    return index;
}

/* The first that fits among those before `end`, or `none`. */
static size_t fitting_find(const struct scheduler_candidate *candidates, size_t end,
                           int64_t free_threads, size_t none)
{
    for (size_t index = 0; index < end; index++) {
        if (candidates[index].threads <= free_threads)
            return index;
    }
    return none;
}

size_t scheduler_pick(struct scheduler *scheduler, const struct scheduler_candidate *candidates,
                      size_t count, int64_t free_threads, double now)
{
    if (count == 0)
        return count;
    size_t blocked = blocked_find(scheduler, candidates, count);
    bool fits = candidates[0].threads <= free_threads;
    if (blocked < count && candidates[blocked].threads <= free_threads &&
        now - scheduler->blocked_since > scheduler_patience &&
        candidates[blocked].priority == candidates[0].priority)
        return blocked;
    /* The head takes the place of one that is gone or less urgent. */
    if (!fits && (blocked == count || candidates[blocked].priority < candidates[0].priority)) {
        (void)snprintf(scheduler->blocked, sizeof scheduler->blocked, "%s", candidates[0].id);
        scheduler->blocked_since = now;
        blocked = 0;
    }
    if (blocked == count || now - scheduler->blocked_since <= scheduler_patience)
        return fitting_find(candidates, count, free_threads, count);
    size_t end = 0;
    while (candidates[end].priority > candidates[blocked].priority)
        end++;
    return fitting_find(candidates, end, free_threads, count);
}

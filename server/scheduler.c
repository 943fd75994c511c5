/* SPDX-License-Identifier: Apache-2.0 */
#include "scheduler.h"

#include <stdio.h>
#include <string.h>

const double scheduler_patience = 10;

size_t scheduler_pick(struct scheduler *scheduler, const struct scheduler_candidate *candidates,
                      size_t count, int64_t free_threads, double now)
{
    if (count == 0)
        return count;
    if (candidates[0].threads <= free_threads) {
        scheduler->blocked[0] = '\0';
        return 0;
    }
    if (strcmp(scheduler->blocked, candidates[0].id) != 0) {
        (void)snprintf(scheduler->blocked, sizeof scheduler->blocked, "%s", candidates[0].id);
        scheduler->blocked_since = now;
    }
    if (now - scheduler->blocked_since > scheduler_patience)
        return count;
    for (size_t index = 1; index < count; index++) {
        if (candidates[index].threads <= free_threads)
            return index;
    }
    return count;
}

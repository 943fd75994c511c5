/* SPDX-License-Identifier: Apache-2.0 */
/* The search for the edge of a condition: from the trials so far to what is to be run next. It
 * keeps no state, so that a search goes on from its recorded trials after any interruption. */
#ifndef TALUS_STUDY_BISECT_H
#define TALUS_STUDY_BISECT_H

#include "study_condition.h"

#include <stdbool.h>
#include <stddef.h>

struct study_bisect {
    const char *parameter; /* JSON Pointer into the scene */
    double low, high;      /* low < high */
    double tolerance;      /* width of the bracket at which the search ends */
    struct condition condition;
};

struct bisect_trial {
    double value;
    bool met; /* a failed job does not meet the condition */
};

enum bisect_state { BISECT_RUN, BISECT_DONE, BISECT_FAILED };

struct bisect_step {
    enum bisect_state state;
    double run[2]; /* BISECT_RUN: values that are not among the trials yet, to be run at once */
    size_t run_count;
    /* BISECT_DONE: the edge lies in low .. high, and `value` is the end that meets the condition.
     * Otherwise the bracket so far. */
    double value, low, high;
    const char *detail; /* BISECT_FAILED: why, for people */
};

/* What to do after `count` trials, in any order. A value whose run has not ended is no trial: do
 * not ask again before it has, or the same value is told again. */
struct bisect_step study_bisect_next(const struct study_bisect *bisect,
                                     const struct bisect_trial *trials, size_t count);

/* The most runs that the search can take. */
size_t study_bisect_runs_max(const struct study_bisect *bisect);

#endif

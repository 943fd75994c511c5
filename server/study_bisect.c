/* SPDX-License-Identifier: Apache-2.0 */
#include "study_bisect.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* The middle with few digits, so that it reads well and comes back from text as the same number. */
static double middle_of(double low, double high)
{
    double middle = low + (high - low) / 2.0;
    for (int digits = 3; digits <= 16; digits++) {
        char text[32];
        (void)snprintf(text, sizeof text, "%.*g", digits, middle);
        double rounded = strtod(text, NULL);
        if (fabs(rounded - middle) <= 1e-3 * (high - low))
            return rounded;
    }
    return middle;
}

static const struct bisect_trial *trial_find(const struct bisect_trial *trials, size_t count,
                                             double value)
{
    for (size_t index = 0; index < count; index++) {
        if (fabs(trials[index].value - value) <= 1e-14 * fabs(value))
            return &trials[index];
    }
    return NULL;
}

struct bisect_step study_bisect_next(const struct study_bisect *bisect,
                                     const struct bisect_trial *trials, size_t count)
{
    struct bisect_step step = {.state = BISECT_RUN, .low = bisect->low, .high = bisect->high};
    const struct bisect_trial *low = trial_find(trials, count, step.low);
    const struct bisect_trial *high = trial_find(trials, count, step.high);
    if (low == NULL)
        step.run[step.run_count++] = step.low;
    if (high == NULL)
        step.run[step.run_count++] = step.high;
    if (low == NULL || high == NULL)
        return step;
    if (low->met == high->met) {
        step.state = BISECT_FAILED;
        step.detail = low->met ? "both ends meet the condition: its edge is not between them"
                               : "neither end meets the condition: its edge is not between them";
        return step;
    }
    while (step.high - step.low > bisect->tolerance) {
        double middle = middle_of(step.low, step.high);
        const struct bisect_trial *trial = trial_find(trials, count, middle);
        if (trial == NULL) {
            step.run[step.run_count++] = middle;
            return step;
        }
        *(trial->met == low->met ? &step.low : &step.high) = middle;
    }
    step.state = BISECT_DONE;
    step.value = low->met ? step.low : step.high;
    return step;
}

size_t study_bisect_runs_max(const struct study_bisect *bisect)
{
    /* Rounding the middle leaves at most 0.501 of a bracket. */
    double halvings = log(bisect->tolerance / (bisect->high - bisect->low)) / log(0.501);
    return halvings <= 0.0 ? 2 : 2 + (size_t)ceil(halvings);
}

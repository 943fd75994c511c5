/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/thread_choice.h"

#include <math.h>

/* Steps of a trial, and between two of them; the other way must be faster by the margin. */
enum { TRIAL_STEPS = 4, INTERVAL_MIN = 10, INTERVAL_MAX = 100000 };
#define MARGIN 0.95
/* Of the time goes into steps that were tried in vain, at most. */
#define TRIAL_SHARE 0.01
/* A trial that is so much slower need not go on. */
#define HOPELESS 2.0
/* Weight of the last step in the smoothed time of one. */
#define SMOOTHING 0.125

int threads_that_pay(uint64_t particle_count, int most)
{
    const uint64_t pay = particle_count / THREAD_PARTICLES;
    return pay <= 1 || most <= 1 ? 1 : pay < (uint64_t)most ? (int)pay : most;
}

void thread_choice_init(struct thread_choice *choice)
{
    *choice = (struct thread_choice){.many = true, .until = INTERVAL_MIN};
}

int thread_choice_next(const struct thread_choice *choice, int pay)
{
    return choice->many != choice->trial ? pay : 1;
}

static void end_trial(struct thread_choice *choice)
{
    const double step = choice->trial_time / choice->steps;
    const double lost = choice->trial_time - choice->steps * choice->recent;
    if (step < MARGIN * choice->recent) {
        choice->many = !choice->many;
        choice->recent = step;
        choice->until = INTERVAL_MIN;
    } else {
        const double wanted = fmax(lost, 0) / (TRIAL_SHARE * choice->recent);
        choice->until =
            (unsigned)fmin(fmax(wanted, fmin(2.0 * choice->until, INTERVAL_MAX)), INTERVAL_MAX);
    }
    choice->trial = false;
    choice->steps = 0;
    choice->trial_time = 0;
}

void thread_choice_note(struct thread_choice *choice, int pay, double seconds)
{
    if (pay <= 1 || !(seconds > 0))
        return;
    choice->steps++;
    if (choice->trial) {
        choice->trial_time += seconds;
        if (choice->steps >= TRIAL_STEPS ||
            choice->trial_time > HOPELESS * choice->steps * choice->recent)
            end_trial(choice);
        return;
    }
    choice->recent =
        choice->recent > 0 ? choice->recent + SMOOTHING * (seconds - choice->recent) : seconds;
    if (choice->steps >= choice->until) {
        choice->trial = true;
        choice->steps = 0;
    }
}

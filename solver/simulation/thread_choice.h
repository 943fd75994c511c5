/* SPDX-License-Identifier: Apache-2.0 */
/* How many threads take the next step. The result has the same bits for any number, so that this
 * may follow the clock.
 *
 * Passes and nodes are separated by some 15 barriers a step, of 1 to 2 us each where every thread
 * has a core: about 25 us, as long as a core needs for 600 to 1200 particles. Two threads on fewer
 * than 2 x THREAD_PARTICLES gain less than a half; more threads than that rule allows are never
 * used. Where the cores are shared, a barrier lasts until the scheduler brings back the slowest
 * thread, milliseconds: so now and then a few steps are taken with one thread instead of many, or
 * the other way round, and the faster way stays. A trial costs at most a hundredth of the time
 * until the next one. */
#ifndef TALUS_THREAD_CHOICE_H
#define TALUS_THREAD_CHOICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { THREAD_PARTICLES = 2000 };

/* Threads that pay for so many particles; at least 1. */
int threads_that_pay(uint64_t particle_count, int most);

struct thread_choice {
    bool many;         /* the way that stays: as many threads as pay, or one */
    bool trial;        /* the other way is being tried */
    unsigned steps;    /* of the trial, or since the last one */
    unsigned until;    /* steps before the next trial */
    double trial_time; /* [s] of the steps of the trial */
    double recent;     /* [s] of a step, smoothed; 0: none yet */
};

void thread_choice_init(struct thread_choice *choice);
/* Threads for the next step, of at most `pay`. */
int thread_choice_next(const struct thread_choice *choice, int pay);
/* How long that step took [s]. */
void thread_choice_note(struct thread_choice *choice, int pay, double seconds);

#endif

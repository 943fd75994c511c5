/* SPDX-License-Identifier: Apache-2.0 */
/* The number of threads follows what steps take. */
#include "simulation/thread_choice.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { MOST = 4, STEPS = 20000 };

/* Seconds of STEPS steps, and how many of the last half went by many threads. */
struct outcome {
    double seconds;
    unsigned many;
};

static struct outcome take_steps(struct thread_choice *choice, double one, double many)
{
    struct outcome outcome = {0, 0};
    for (unsigned step = 0; step < STEPS; step++) {
        const int threads = thread_choice_next(choice, MOST);
        const double seconds = threads == 1 ? one : many;
        assert_true(threads == 1 || threads == MOST);
        outcome.seconds += seconds;
        outcome.many += step >= STEPS / 2 && threads == MOST;
        thread_choice_note(choice, MOST, seconds);
    }
    return outcome;
}

static void few_particles_take_one_thread(void **state)
{
    (void)state;
    assert_int_equal(threads_that_pay(0, 8), 1);
    assert_int_equal(threads_that_pay(1000, 8), 1);
    assert_int_equal(threads_that_pay((uint64_t)2 * THREAD_PARTICLES - 1, 8), 1);
    assert_int_equal(threads_that_pay((uint64_t)2 * THREAD_PARTICLES, 8), 2);
    assert_int_equal(threads_that_pay((uint64_t)100 * THREAD_PARTICLES, 8), 8);
    assert_int_equal(threads_that_pay(UINT64_MAX, 1), 1);
}

static void what_pays_stays(void **state)
{
    struct thread_choice choice;
    (void)state;
    thread_choice_init(&choice);
    const struct outcome outcome = take_steps(&choice, 1e-3, 3e-4);
    assert_true(outcome.many > 0.99 * (0.5 * STEPS));
    assert_true(outcome.seconds < 1.02 * STEPS * 3e-4);
}

/* Another program takes the cores: barriers wait for the scheduler. */
static void shared_cores_leave_one_thread(void **state)
{
    struct thread_choice choice;
    (void)state;
    thread_choice_init(&choice);
    const struct outcome outcome = take_steps(&choice, 1e-3, 3e-2);
    assert_true(outcome.many < 0.001 * (0.5 * STEPS));
    /* The first steps, before the first trial, are lost. */
    assert_true(outcome.seconds - 10 * 3e-2 < 1.02 * STEPS * 1e-3);
    /* The cores get free again. */
    const struct outcome after = take_steps(&choice, 1e-3, 3e-4);
    assert_true(after.many > 0.99 * (0.5 * STEPS));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_particles_take_one_thread),
        cmocka_unit_test(what_pays_stays),
        cmocka_unit_test(shared_cores_leave_one_thread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

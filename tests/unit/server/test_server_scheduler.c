/* SPDX-License-Identifier: Apache-2.0 */
#include "scheduler.h"
#include "server_fixture.h"

static const struct scheduler_candidate queue[] = {
    {.id = "wide", .threads = 4},
    {.id = "middle", .threads = 2},
    {.id = "narrow", .threads = 1},
};

static void test_the_head_goes_first(void **state)
{
    struct scheduler scheduler = {0};
    (void)state;
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 4, 0), 0);
    assert_int_equal(scheduler_pick(&scheduler, queue, 0, 4, 0), 0);
}

static void test_smaller_ones_pass_for_a_while(void **state)
{
    struct scheduler scheduler = {0};
    (void)state;
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 3, 100), 1);
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 1, 100.5), 2);
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 0, 101), 3);
    double late = 100 + scheduler_patience + 0.1;
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 3, late), 3);
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 4, late), 0);
}

static void test_patience_begins_anew_for_another_head(void **state)
{
    struct scheduler scheduler = {0};
    (void)state;
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 1, 0), 2);
    double late = scheduler_patience + 1;
    assert_int_equal(scheduler_pick(&scheduler, queue + 1, 2, 1, late), 1);
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 3, late + 1), 1);
}

static void test_a_wide_job_is_not_starved_by_other_heads(void **state)
{
    const struct scheduler_candidate other[] = {
        {.id = "another", .threads = 1},
        {.id = "wide", .threads = 4},
        {.id = "middle", .threads = 2},
    };
    struct scheduler scheduler = {0};
    (void)state;
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 3, 0), 1);
    assert_int_equal(scheduler_pick(&scheduler, other, 3, 3, 5), 0);
    double late = scheduler_patience + 1;
    assert_int_equal(scheduler_pick(&scheduler, other, 3, 3, late), 3);
    assert_int_equal(scheduler_pick(&scheduler, other, 3, 4, late), 1);
}

static void test_priority_passes_what_waits(void **state)
{
    const struct scheduler_candidate urgent[] = {
        {.id = "urgent", .threads = 1, .priority = 5},
        {.id = "wide", .threads = 4},
        {.id = "narrow", .threads = 1},
    };
    struct scheduler scheduler = {0};
    (void)state;
    assert_int_equal(scheduler_pick(&scheduler, queue, 3, 3, 0), 1);
    double late = scheduler_patience + 1;
    assert_int_equal(scheduler_pick(&scheduler, urgent, 3, 3, late), 0);
    assert_int_equal(scheduler_pick(&scheduler, urgent + 1, 2, 3, late), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_head_goes_first),
        cmocka_unit_test(test_smaller_ones_pass_for_a_while),
        cmocka_unit_test(test_patience_begins_anew_for_another_head),
        cmocka_unit_test(test_a_wide_job_is_not_starved_by_other_heads),
        cmocka_unit_test(test_priority_passes_what_waits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

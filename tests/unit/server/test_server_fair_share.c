/* SPDX-License-Identifier: Apache-2.0 */
#include "fair_share.h"
#include "server_fixture.h"

#include <math.h>

static void order(const struct fair_share *share, struct scheduler_candidate *candidates,
                  size_t count, const char *expected)
{
    char text[64] = "";
    fair_share_order(share, candidates, count);
    for (size_t index = 0; index < count; index++)
        text[index] = candidates[index].id[0];
    assert_string_equal(text, expected);
}

static void test_priority_then_threads_then_age(void **state)
{
    struct scheduler_candidate candidates[] = {
        {.id = "a", .owner = "busy"}, {.id = "b", .owner = "idle"},
        {.id = "c", .owner = "idle"}, {.id = "d", .owner = "busy", .priority = 1},
        {.id = "e", .owner = "some"},
    };
    struct fair_share share = {0};
    (void)state;
    fair_share_begin(&share, 1);
    assert_true(fair_share_note(&share, "busy", 3));
    assert_true(fair_share_note(&share, "some", 1));
    assert_true(fair_share_note(&share, "some", 1));
    assert_int_equal(fair_share_jobs(&share, "some"), 2);
    assert_int_equal(fair_share_jobs(&share, "idle"), 0);
    order(&share, candidates, 5, "dbcea");
    fair_share_release(&share);
}

static void test_use_decides_among_equals_and_fades(void **state)
{
    struct scheduler_candidate candidates[] = {{.id = "a", .owner = "first"},
                                               {.id = "b", .owner = "second"}};
    struct fair_share share = {0};
    (void)state;
    fair_share_begin(&share, 1);
    assert_true(fair_share_note(&share, "first", 2));
    fair_share_begin(&share, 11);
    order(&share, candidates, 2, "ba");
    assert_true(fabs(candidates[1].owner_use - 20) < 1e-9);
    fair_share_begin(&share, 11 + fair_share_half_life);
    order(&share, candidates, 2, "ba");
    assert_true(fabs(candidates[1].owner_use - 10) < 1e-9);
    fair_share_begin(&share, 11 + 100 * fair_share_half_life);
    order(&share, candidates, 2, "ab");
    assert_null(share.first);
}

/* One thread, two owners whose queues never end, one with much more: they take turns. */
static void test_nobody_starves(void **state)
{
    struct fair_share share = {0};
    int started[2] = {0, 0};
    double now = 1;
    (void)state;
    for (int turn = 0; turn < 100; turn++) {
        struct scheduler_candidate candidates[] = {{.id = "a", .owner = "many"},
                                                   {.id = "b", .owner = "many"},
                                                   {.id = "c", .owner = "few"}};
        fair_share_begin(&share, now);
        fair_share_order(&share, candidates, 3);
        const char *owner = candidates[0].owner;
        started[owner[0] == 'f']++;
        assert_true(fair_share_note(&share, owner, 1));
        now += 5;
    }
    assert_int_equal(started[0], 50);
    assert_int_equal(started[1], 50);
    fair_share_release(&share);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_priority_then_threads_then_age),
        cmocka_unit_test(test_use_decides_among_equals_and_fades),
        cmocka_unit_test(test_nobody_starves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

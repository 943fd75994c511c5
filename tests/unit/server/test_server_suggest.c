/* SPDX-License-Identifier: Apache-2.0 */
#include "server_fixture.h"
#include "suggest.h"

static void test_near_misses(void **state)
{
    static const char *const names[] = {"scene", "name", "labels", "priority", "threads", NULL};
    (void)state;
    assert_string_equal(suggest("prioriti", names), "priority");
    assert_string_equal(suggest("lables", names), "labels");
    assert_string_equal(suggest("nmae", names), "name");
    assert_string_equal(suggest("thread", names), "threads");
    assert_null(suggest("completely", names));
    assert_null(suggest("", names));
    assert_null(suggest("x", names));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_near_misses)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "server_fixture.h"
#include "target.h"

#include <string.h>

static void test_good_targets(void **state)
{
    struct target target;
    (void)state;
    assert_null(target_parse(&target, "/v1/jobs/a%20b?limit=5&label=k%3Av+w&flag"));
    assert_int_equal(target.segment_count, 3);
    assert_string_equal(target.segments[2], "a b");
    assert_string_equal(target_query(&target, "limit"), "5");
    assert_string_equal(target_query(&target, "label"), "k:v w");
    assert_string_equal(target_query(&target, "flag"), "");
    assert_null(target_query(&target, "none"));
    target_release(&target);
    assert_null(target_parse(&target, "/"));
    assert_int_equal(target.segment_count, 0);
    target_release(&target);
    assert_null(target_parse(&target, "/%c3%bc?q=%C3%BC"));
    assert_string_equal(target.segments[0], "\xc3\xbc");
    target_release(&target);
}

static void test_bad_targets(void **state)
{
    static const char *const bad[] = {
        "",
        "v1",
        "*",
        "http://x/",
        "/a%",
        "/a%2",
        "/a%zz",
        "/a%00b",
        "/%0a",
        "/%7f",
        "/..",
        "/a/../b",
        "/a/./b",
        "/%2e%2e/b",
        "/a%2fb",
        "/a%5cb",
        "/a b",
        "/a#b",
        "/a\x01",
        "/a\xff",
        "/%ff",
        "/%c0%af",
        "/a?b=%00",
        "/a?b=%",
        "/a?b=%ff",
        "/a<b",
        "/a\"b",
        "/a\\b",
        "/a|b",
        "/a`b",
        "/1/2/3/4/5/6/7/8/9/10/11/12/13/14/15/16/17",
        "/?a&b&c&d&e&f&g&h&i&j&k&l&m&n&o&p&q",
    };
    (void)state;
    for (size_t index = 0; index < sizeof bad / sizeof bad[0]; index++) {
        struct target target;
        if (target_parse(&target, bad[index]) == NULL)
            fail_msg("accepted: %s", bad[index]);
        target_release(&target);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good_targets),
        cmocka_unit_test(test_bad_targets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "identifier.h"
#include "server_fixture.h"

#include <string.h>

static void test_identifiers_grow(void **state)
{
    struct identifier_source source;
    struct talus_error error = {0};
    char last[IDENTIFIER_LENGTH + 1] = "", next[IDENTIFIER_LENGTH + 1];
    (void)state;
    assert_int_equal(identifier_source_init(&source, &error), TALUS_OK);
    for (int count = 0; count < 20000; count++) {
        assert_int_equal(identifier_next(&source, next, &error), TALUS_OK);
        assert_true(identifier_valid(next));
        assert_true(strcmp(next, last) > 0);
        memcpy(last, next, sizeof last);
    }
    identifier_source_release(&source);
}

static void test_only_their_form_is_valid(void **state)
{
    (void)state;
    assert_true(identifier_valid("01m817k35wqk69zp9g1vc1hvc8"));
    assert_false(identifier_valid("01m817k35wqk69zp9g1vc1hvc"));
    assert_false(identifier_valid("01m817k35wqk69zp9g1vc1hvc88"));
    assert_false(identifier_valid("01M817k35wqk69zp9g1vc1hvc8"));
    assert_false(identifier_valid("../../35wqk69zp9g1vc1hvc8x"));
    assert_false(identifier_valid(""));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_identifiers_grow),
        cmocka_unit_test(test_only_their_form_is_valid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

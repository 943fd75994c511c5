/* SPDX-License-Identifier: Apache-2.0 */
#include "byte_range.h"
#include "server_fixture.h"

static void expect(const char *header, uint64_t size, enum byte_range kind, uint64_t first,
                   uint64_t length)
{
    uint64_t got_first = 0, got_length = 0;
    assert_int_equal(byte_range_parse(header, size, &got_first, &got_length), kind);
    assert_int_equal(got_first, first);
    assert_int_equal(got_length, length);
}

static void test_parts(void **state)
{
    (void)state;
    expect("bytes=0-0", 10, BYTE_RANGE_PART, 0, 1);
    expect("bytes=2-5", 10, BYTE_RANGE_PART, 2, 4);
    expect("bytes=5-", 10, BYTE_RANGE_PART, 5, 5);
    expect("bytes=-3", 10, BYTE_RANGE_PART, 7, 3);
    expect("bytes=-30", 10, BYTE_RANGE_PART, 0, 10);
    expect("bytes=8-100", 10, BYTE_RANGE_PART, 8, 2);
    expect("Bytes=1-1", 10, BYTE_RANGE_PART, 1, 1);
    expect("bytes=3-99999999999999999999999", 10, BYTE_RANGE_PART, 3, 7);
}

static void test_unsatisfiable(void **state)
{
    (void)state;
    expect("bytes=10-", 10, BYTE_RANGE_UNSATISFIABLE, 0, 0);
    expect("bytes=99999999999999999999999-", 10, BYTE_RANGE_UNSATISFIABLE, 0, 0);
    expect("bytes=-0", 10, BYTE_RANGE_UNSATISFIABLE, 0, 0);
    expect("bytes=-5", 0, BYTE_RANGE_UNSATISFIABLE, 0, 0);
    expect("bytes=0-", 0, BYTE_RANGE_UNSATISFIABLE, 0, 0);
}

static void test_ignored(void **state)
{
    static const char *const headers[] = {"bytes=5-2",
                                          "bytes=",
                                          "bytes=-",
                                          "bytes=a-b",
                                          "bytes=1-2x",
                                          "bytes=1,2-3",
                                          "bytes=1-2,4-5",
                                          "bytes= 1-2",
                                          "bytes=+1-2",
                                          "lines=1-2",
                                          ""};
    (void)state;
    expect(NULL, 10, BYTE_RANGE_WHOLE, 0, 0);
    for (size_t index = 0; index < sizeof headers / sizeof headers[0]; index++)
        expect(headers[index], 10, BYTE_RANGE_WHOLE, 0, 0);
}

static void test_entity_tags(void **state)
{
    (void)state;
    assert_true(etag_listed("\"5\"", "\"5\"", false));
    assert_true(etag_listed("\"4\" , \"5\"", "\"5\"", false));
    assert_true(etag_listed("*", "\"5\"", false));
    assert_true(etag_listed("W/\"5\"", "\"5\"", true));
    assert_false(etag_listed("W/\"5\"", "\"5\"", false));
    assert_false(etag_listed("\"55\"", "\"5\"", true));
    assert_false(etag_listed("5", "\"5\"", true));
    assert_false(etag_listed("", "\"5\"", true));
    assert_false(etag_listed(", ,", "\"5\"", true));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_unsatisfiable),
        cmocka_unit_test(test_ignored),
        cmocka_unit_test(test_entity_tags),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

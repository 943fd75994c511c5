/* SPDX-License-Identifier: Apache-2.0 */
/* Texts, times and checksums. */
#include "checksum.h"
#include "json_text.h"
#include "moment.h"
#include "server_fixture.h"
#include "text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void expect_number(double value, const char *expected)
{
    struct text text = {0};
    text_add_number(&text, value);
    assert_string_equal(text.data, expected);
    text_release(&text);
}

static void test_numbers(void **state)
{
    (void)state;
    expect_number(0, "0");
    expect_number(0.1, "0.1");
    expect_number(-1e300, "-1e+300");
    expect_number(1.0 / 3, "0.3333333333333333");
    expect_number(NAN, "null");
    expect_number(INFINITY, "null");
    for (int power = -300; power <= 300; power += 7) {
        struct text text = {0};
        double value = M_PI * pow(10, power);
        text_add_number(&text, value);
        assert_true(strtod(text.data, NULL) == value);
        text_release(&text);
    }
}

static void test_growth(void **state)
{
    struct text text = {0};
    (void)state;
    for (int count = 0; count < 1000; count++)
        text_print(&text, "%d,", count);
    assert_int_equal(text.length, 10 * 2 + 90 * 3 + 900 * 4);
    text_drop(&text, 2);
    assert_int_equal(strncmp(text.data, "1,2,", 4), 0);
    text_drop(&text, 1000000);
    assert_int_equal(text.length, 0);
    text_add(&text, "", 0);
    char *taken = text_take(&text);
    assert_string_equal(taken, "");
    assert_null(text.data);
    free(taken);
}

static void test_moments(void **state)
{
    char text[MOMENT_TEXT_SIZE];
    (void)state;
    moment_text(0, text);
    assert_string_equal(text, "1970-01-01T00:00:00.000Z");
    moment_text(1795335204.25, text);
    assert_string_equal(text, "2026-11-22T08:13:24.250Z");
}

static void expect_json(const char *in, unsigned int indent, const char *expected)
{
    json_t *value = json_loads(in, JSON_DECODE_ANY, NULL);
    char *text = json_text(value, indent);
    assert_non_null(text);
    assert_string_equal(text, expected);
    json_t *again = json_loads(text, JSON_DECODE_ANY, NULL);
    assert_true(json_equal(value, again));
    json_decref(again);
    json_decref(value);
    free(text);
}

static void test_json(void **state)
{
    (void)state;
    expect_json("{\"a\":[0.1,1,-2],\"b\":{},\"c\":[],\"d\":null}", 0,
                "{\"a\":[0.1,1,-2],\"b\":{},\"c\":[],\"d\":null}");
    expect_json("{\"a\":[0.1,1],\"b\":[{\"x\":true}]}", 2,
                "{\n  \"a\": [0.1, 1],\n  \"b\": [\n    {\n      \"x\": true\n    }\n  ]\n}");
    expect_json("\"\\\"\\n\\u00e9\"", 0, "\"\\\"\\n\xc3\xa9\"");
    assert_null(json_text(NULL, 0));
}

static void expect_equal(const char *a, const char *b, bool equal)
{
    struct talus_error error = {0};
    char first[CHECKSUM_SIZE], second[CHECKSUM_SIZE];
    json_t *left = json_loads(a, JSON_DECODE_ANY, NULL);
    json_t *right = json_loads(b, JSON_DECODE_ANY, NULL);
    assert_int_equal(checksum_json(left, first, &error), TALUS_OK);
    assert_int_equal(checksum_json(right, second, &error), TALUS_OK);
    assert_int_equal(strcmp(first, second) == 0, equal);
    json_decref(left);
    json_decref(right);
}

static void test_equal_json(void **state)
{
    (void)state;
    expect_equal("{\"a\":1,\"b\":[2.0,3]}", "{ \"b\": [2, 3.0], \"a\": 1e0 }", true);
    expect_equal("{\"a\":1}", "{\"a\":1.5}", false);
    expect_equal("{\"a\":1}", "{\"a\":\"1\"}", false);
    expect_equal("[1,2]", "[2,1]", false);
    expect_equal("{\"a\":null}", "{}", false);
    expect_equal("1e300", "1e301", false);
}

static void test_sha256(void **state)
{
    /* FIPS 180-2, appendix B.1 */
    struct talus_error error = {0};
    char checksum[CHECKSUM_SIZE];
    (void)state;
    assert_int_equal(checksum_memory("abc", 3, checksum, &error), TALUS_OK);
    assert_string_equal(checksum,
                        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers), cmocka_unit_test(test_growth),
        cmocka_unit_test(test_moments), cmocka_unit_test(test_equal_json),
        cmocka_unit_test(test_sha256),  cmocka_unit_test(test_json),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

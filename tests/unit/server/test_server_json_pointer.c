/* SPDX-License-Identifier: Apache-2.0 */
/* JSON Pointers: the examples of RFC 6901, what fits and what does not, and that putting a value
 * leaves the document as it was. */
#include "json_pointer.h"
#include "server_fixture.h"

#include <string.h>

static json_t *parse(const char *text)
{
    json_t *value = json_loads(text, JSON_DECODE_ANY, NULL);
    assert_non_null(value);
    return value;
}

static void test_get(void **state)
{
    static const struct {
        const char *pointer, *value;
    } cases[] = {
        {"/foo", "[\"bar\",\"baz\"]"},
        {"/foo/0", "\"bar\""},
        {"/", "0"},
        {"/a~1b", "1"},
        {"/c%d", "2"},
        {"/m~0n", "8"},
        {"/m~01", "9"},
        {"/foo/2", NULL},
        {"/foo/00", NULL},
        {"/foo/-", NULL},
        {"/foo/0/x", NULL},
        {"/foo/18446744073709551616", NULL},
        {"/bar", NULL},
    };
    json_t *document = parse("{\"foo\":[\"bar\",\"baz\"],\"\":0,\"a/b\":1,\"c%d\":2,\"m~n\":8,"
                             "\"m~1\":9}");
    (void)state;
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        const json_t *found = json_pointer_get(document, cases[index].pointer);
        json_t *expected = cases[index].value == NULL ? NULL : parse(cases[index].value);
        if (expected == NULL ? found != NULL : !json_equal(found, expected))
            fail_msg("%s", cases[index].pointer);
        json_decref(expected);
    }
    json_decref(document);
}

static void test_valid(void **state)
{
    char deep[2 * JSON_POINTER_DEPTH_MAX + 3] = "", longest[JSON_POINTER_SIZE + 1];
    (void)state;
    assert_true(json_pointer_is_valid("/"));
    assert_true(json_pointer_is_valid("/a/0/~0~1"));
    assert_false(json_pointer_is_valid(""));
    assert_false(json_pointer_is_valid("a"));
    assert_false(json_pointer_is_valid("#/a"));
    assert_false(json_pointer_is_valid("/~"));
    assert_false(json_pointer_is_valid("/a~2"));
    for (int depth = 0; depth < JSON_POINTER_DEPTH_MAX; depth++)
        memcpy(deep + 2 * depth, "/a", 3);
    assert_true(json_pointer_is_valid(deep));
    memcpy(deep + 2 * JSON_POINTER_DEPTH_MAX, "/", 2);
    assert_false(json_pointer_is_valid(deep));
    memset(longest, '/', 1);
    memset(longest + 1, 'a', sizeof longest - 2);
    longest[JSON_POINTER_SIZE] = '\0';
    assert_false(json_pointer_is_valid(longest));
    longest[JSON_POINTER_SIZE - 1] = '\0';
    assert_true(json_pointer_is_valid(longest));
}

static void test_within(void **state)
{
    (void)state;
    assert_true(json_pointer_is_within("/a/b", "/a"));
    assert_true(json_pointer_is_within("/a", "/a"));
    assert_false(json_pointer_is_within("/ab", "/a"));
    assert_false(json_pointer_is_within("/a", "/a/b"));
}

static void test_join(void **state)
{
    char pointer[JSON_POINTER_SIZE], key[2 * JSON_POINTER_SIZE];
    (void)state;
    json_pointer_join(pointer, "/x", "a/b~c");
    assert_string_equal(pointer, "/x/a~1b~0c");
    json_pointer_join(pointer, pointer, "");
    json_pointer_join_index(pointer, pointer, 12);
    assert_string_equal(pointer, "/x/a~1b~0c//12");
    memset(key, '~', sizeof key);
    key[sizeof key - 1] = '\0';
    for (size_t keep = 0; keep < 4; keep++) { /* cut, whatever the parity, and never half a ~0 */
        key[keep] = 'a';
        json_pointer_join(pointer, "", key);
        assert_true(strlen(pointer) < JSON_POINTER_SIZE);
        assert_true(json_pointer_is_valid(pointer));
        json_pointer_join(pointer, pointer, "more");
        assert_true(strlen(pointer) < JSON_POINTER_SIZE);
    }
}

static void test_check(void **state)
{
    static const struct {
        const char *pointer;
        enum json_pointer_fit fit;
        size_t length;
    } cases[] = {
        {"/a", JSON_POINTER_FITS, 2},          {"/new", JSON_POINTER_FITS, 4},
        {"/a/b/0", JSON_POINTER_FITS, 6},      {"/a/b/2", JSON_POINTER_FITS, 6},
        {"/a/b/-", JSON_POINTER_FITS, 6},      {"/a/b/3", JSON_POINTER_INDEX, 6},
        {"/a/b/x", JSON_POINTER_INDEX, 6},     {"/a/b/01", JSON_POINTER_INDEX, 7},
        {"/a/b/-/c", JSON_POINTER_NOWHERE, 6}, {"/a/b/-1/c", JSON_POINTER_INDEX, 7},
        {"/new/c", JSON_POINTER_NOWHERE, 4},   {"/s/c", JSON_POINTER_NOWHERE, 2},
        {"/a/b/1/c", JSON_POINTER_NOWHERE, 6}, {"/n/c/d", JSON_POINTER_NOWHERE, 2},
    };
    json_t *document = parse("{\"a\":{\"b\":[1,2]},\"s\":\"text\",\"n\":null}");
    json_t *plain = json_integer(3);
    (void)state;
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        size_t length = 99;
        enum json_pointer_fit fit = json_pointer_check(document, cases[index].pointer, &length);
        if (fit != cases[index].fit || length != cases[index].length)
            fail_msg("%s: %d, %zu", cases[index].pointer, (int)fit, length);
    }
    assert_int_equal(json_pointer_check(plain, "/a", NULL), JSON_POINTER_NOWHERE);
    json_decref(plain);
    json_decref(document);
}

static void expect_put(const char *pointer, const char *expected_text)
{
    static const char before[] = "{\"a\":{\"b\":[1,2],\"c\":{\"d\":3}},\"e\":{\"f\":4}}";
    json_t *document = parse(before), *untouched = parse(before), *value = json_string("new");
    json_t *result = json_pointer_put(document, pointer, value);
    json_t *expected = expected_text == NULL ? NULL : parse(expected_text);
    if (expected == NULL ? result != NULL : !json_equal(result, expected))
        fail_msg("%s", pointer);
    assert_true(json_equal(document, untouched));
    if (strncmp(pointer, "/a", 2) == 0 && result != NULL) /* the rest is shared */
        assert_ptr_equal(json_object_get(result, "e"), json_object_get(document, "e"));
    json_decref(result);
    json_decref(value);
    json_decref(document);
    json_decref(untouched);
    json_decref(expected);
}

static void test_put(void **state)
{
    (void)state;
    expect_put("/a", "{\"a\":\"new\",\"e\":{\"f\":4}}");
    expect_put("/a/b/1", "{\"a\":{\"b\":[1,\"new\"],\"c\":{\"d\":3}},\"e\":{\"f\":4}}");
    expect_put("/a/b/2", "{\"a\":{\"b\":[1,2,\"new\"],\"c\":{\"d\":3}},\"e\":{\"f\":4}}");
    expect_put("/a/b/-", "{\"a\":{\"b\":[1,2,\"new\"],\"c\":{\"d\":3}},\"e\":{\"f\":4}}");
    expect_put("/a/c/x~1y",
               "{\"a\":{\"b\":[1,2],\"c\":{\"d\":3,\"x/y\":\"new\"}},\"e\":{\"f\":4}}");
    expect_put("/a/b/3", NULL);
    expect_put("/a/b/0/z", NULL);
    expect_put("/x/y", NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_get),  cmocka_unit_test(test_valid), cmocka_unit_test(test_within),
        cmocka_unit_test(test_join), cmocka_unit_test(test_check), cmocka_unit_test(test_put),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

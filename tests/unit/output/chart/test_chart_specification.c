/* SPDX-License-Identifier: Apache-2.0 */
/* What a chart is asked for: how rows are counted, each mistake with its place, and that nothing
 * that is sent ends the process. */
#include "output/chart_place.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ROW(PARAMETERS, STATE, METRICS)                                                            \
    "{\"parameters\":{" PARAMETERS "},\"state\":\"" STATE "\",\"metrics\":" METRICS "}"

static json_t *parse(const char *text)
{
    json_t *value = json_loads(text, JSON_DECODE_ANY, NULL);
    if (value == NULL)
        fail_msg("not JSON: %s", text);
    return value;
}

static void test_rows_are_counted(void **state)
{
    struct talus_error error = {0};
    json_t *specification = parse(
        "{\"rows\":[" ROW("\"a\":2,\"s\":10", "succeeded", "{\"m\":5}") "," ROW("\"a\":1,\"s\":9", "succeeded", "{\"m\":null}") "," ROW(
            "\"a\":1,\"s\":9", "failed",
            "null") "," ROW("\"a\":1", "cancelled",
                            "{}") "," ROW("\"a\":1", "queued",
                                          "{}") "," ROW("\"a\":1", "succeeded",
                                                        "{\"m\":4}") "," ROW("\"a\":3,\"s\":2.5",
                                                                             "succeeded",
                                                                             "{\"m\":-1}") "," ROW("\"a\":3,\"s\":9",
                                                                                                   "succeeded",
                                                                                                   "{\"m\":1e200}") "],\"chart\":{\"x\":"
                                                                                                                    "\"a\",\"y\":\"m\","
                                                                                                                    "\"series\":\"s\",\"log\":"
                                                                                                                    "\"y\"}}");
    (void)state;
    struct chart *chart = chart_create(specification, &error);
    assert_non_null(chart);
    assert_int_equal(chart->count, 1);
    assert_int_equal(chart->failed, 2);
    assert_int_equal(chart->unfinished, 1);
    assert_int_equal(chart->missing, 3); /* null, no series, and beyond all axes */
    assert_int_equal(chart->not_positive, 1);
    assert_true(chart_has_note(chart));
    assert_true(chart->x.is_parameter && !chart->y.is_parameter);
    assert_true(chart->series.words.numeric);
    assert_int_equal(chart->series_count, 3); /* ascending, 2.5 before 9 before 10 */
    assert_string_equal(chart->series.words.items[0].text, "2.5");
    assert_string_equal(chart->series.words.items[2].text, "10");
    assert_int_equal(chart->points[0].series, 2);
    chart_destroy(chart);
    json_decref(specification);
}

static void test_units(void **state)
{
    struct talus_error error = {0};
    char label[200];
    json_t *specification = parse("{\"rows\":[" ROW(
        "\"a\":2", "succeeded",
        "{\"f\":5e6,\"wall_seconds\":3}") "],"
                                          "\"chart\":{\"x\":\"wall_seconds\",\"y\":\"f\"},"
                                          "\"units\":{\"f\":\"N\"}}");
    (void)state;
    struct chart *chart = chart_create(specification, &error);
    assert_non_null(chart);
    chart_quantity_label(&chart->x, label, sizeof label);
    assert_string_equal(label, "wall_seconds [s]");
    chart_quantity_label(&chart->y, label, sizeof label);
    assert_string_equal(label, "f [MN]");
    assert_true(fabs(chart->points[0].y - 5.0) < 1e-12);
    chart_destroy(chart);
    json_decref(specification);
}

static void expect(const char *text, const char *pointer, const char *code)
{
    struct talus_error error = {0};
    json_t *specification = parse(text);
    char *svg = NULL;
    enum talus_status status = chart_svg(specification, &svg, &error);
    if (status != TALUS_INVALID || svg != NULL || strcmp(error.pointer, pointer) != 0 ||
        strcmp(error.code, code) != 0)
        fail_msg("%s\n%s: %s %s", text, error.pointer, error.code, error.text);
    json_decref(specification);
}

#define CHART(MORE) "{\"rows\":[],\"chart\":{\"x\":\"a\",\"y\":\"b\"}" MORE "}"
#define AXES(KEYS)                                                                                 \
    "{\"rows\":[" ROW("\"a\":1,\"w\":\"text\"", "succeeded", "{\"m\":1}") "],\"chart\":{" KEYS "}" \
                                                                          "}"

static void test_mistakes(void **state)
{
    (void)state;
    expect("[]", "", "type");
    expect("{}", "/chart", "required");
    expect("{\"chart\":{\"x\":\"a\",\"y\":\"b\"}}", "/rows", "required");
    expect("{\"rows\":{},\"chart\":{\"x\":\"a\",\"y\":\"b\"}}", "/rows", "type");
    expect("{\"rows\":[5],\"chart\":{\"x\":\"a\",\"y\":\"b\"}}", "/rows/0", "type");
    expect("{\"rows\":[{}],\"chart\":{\"x\":\"a\",\"y\":\"b\"}}", "/rows/0", "type");
    expect("{\"rows\":[{\"parameters\":{},\"metrics\":[]}],\"chart\":{\"x\":\"a\",\"y\":\"b\"}}",
           "/rows/0", "type");
    expect("{\"rows\":[],\"chart\":[]}", "/chart", "type");
    expect(CHART(",\"titel\":\"t\""), "", "unknown_key");
    expect(CHART(",\"title\":5"), "/title", "type");
    expect(CHART(",\"kind\":\"pie\""), "/kind", "unknown_value");
    expect(CHART(",\"kind\":5"), "/kind", "type");
    expect(CHART(",\"units\":[]"), "/units", "type");
    expect(CHART(",\"units\":{\"a\":5}"), "/units", "type");
    expect(CHART(",\"width\":\"5\""), "/width", "type");
    expect(CHART(",\"width\":5"), "/width", "range");
    expect(CHART(",\"width\":1e9"), "/width", "range");
    expect(AXES("\"y\":\"m\""), "/chart/x", "required");
    expect(AXES("\"x\":\"a\""), "/chart/y", "required");
    expect(AXES("\"x\":5,\"y\":\"m\""), "/chart/x", "type");
    expect(AXES("\"x\":\"a\",\"y\":\"m\",\"seires\":\"s\""), "/chart", "unknown_key");
    expect(AXES("\"x\":\"a\",\"y\":\"m\",\"series\":\"s\""), "/chart/series", "unknown_value");
    expect(AXES("\"x\":\"a\",\"y\":\"m\",\"log\":5"), "/chart/log", "type");
    expect(AXES("\"x\":\"a\",\"y\":\"m\",\"log\":\"\""), "/chart/log", "type");
    expect(AXES("\"x\":\"a\",\"y\":\"m\",\"log\":\"xz\""), "/chart/log", "type");
    expect(AXES("\"x\":\"a\",\"y\":\"m\",\"log\":[\"x\",5]"), "/chart/log", "type");
    expect(AXES("\"x\":\"w\",\"y\":\"a\",\"z\":\"m\""), "/chart/x", "type");
    expect(AXES("\"x\":\"a\",\"y\":\"w\",\"z\":\"m\""), "/chart/y", "type");
    expect(AXES("\"x\":\"a\",\"y\":\"a\",\"z\":\"w\""), "/chart/z", "type");
}

/* Draws whatever it is; a good one is a whole SVG. True if it was drawn. */
static bool draw(const json_t *specification)
{
    struct talus_error error = {0};
    char *svg = NULL;
    enum talus_status status = chart_svg(specification, &svg, &error);
    if (status == TALUS_OK) {
        assert_non_null(strstr(svg, "</svg>"));
        assert_null(strstr(svg, "nan"));
        assert_null(strstr(svg, "inf"));
    } else {
        assert_int_equal(status, TALUS_INVALID);
        assert_true(error.code[0] != '\0' && error.text[0] != '\0');
    }
    free(svg);
    return status == TALUS_OK;
}

static const char *const numbers[] = {"0",     "1",    "-1",       "1e300", "-1e300", "1e-300",
                                      "5e149", "null", "\"text\"", "2",     "1e-149", "1000000007"};

/* Rows of odd numbers, on every kind of chart and scale. */
static void test_odd_numbers(void **state)
{
    enum { NUMBERS = sizeof numbers / sizeof numbers[0] };
    static const char *const charts[] = {
        "{\"x\":\"a\",\"y\":\"m\",\"series\":\"b\"}",
        "{\"x\":\"a\",\"y\":\"m\",\"log\":true}",
        "{\"x\":\"m\",\"y\":\"n\",\"series\":\"b\",\"log\":[\"x\"]}",
        "{\"x\":\"c\",\"y\":\"d\",\"z\":\"m\"}",
        "{\"x\":\"c\",\"y\":\"d\",\"z\":\"m\",\"series\":\"b\",\"log\":[\"x\",\"y\",\"z\"]}",
        "{\"x\":\"x\",\"y\":\"y\"}",
    };
    static const char *const kinds[] = {"grid", "sample", "work_precision"};
    unsigned int random = 3;
    size_t drawn = 0;
    (void)state;
    for (size_t trial = 0; trial < 240; trial++) {
        json_t *rows = json_array();
        for (size_t row = 0; row < trial % 23; row++) {
            char text[300];
            const char *picked[6];
            for (size_t index = 0; index < 6; index++) {
                random = random * 1664525U + 1013904223U;
                picked[index] = numbers[(random >> 16) % NUMBERS];
            }
            (void)snprintf(text, sizeof text,
                           "{\"parameters\":{\"a\":%s,\"b\":%s,\"c\":%u.5,\"d\":%u},\"state\":"
                           "\"succeeded\",\"metrics\":{\"m\":%s,\"n\":%s}}",
                           picked[0], picked[1], random % 5, (random >> 8) % 7, picked[4],
                           picked[5]);
            (void)json_array_append_new(rows, parse(text));
        }
        json_t *specification = json_pack("{s:o, s:o, s:s}", "rows", rows, "chart",
                                          parse(charts[trial % 6]), "kind", kinds[trial / 6 % 3]);
        drawn += draw(specification);
        json_decref(specification);
    }
    assert_true(drawn > 200);
}

/* The member of a document with a number, in depth-first order. */
static bool replace(json_t *value, size_t *number, json_t *by)
{
    const char *key;
    json_t *member;
    size_t index;
    json_object_foreach(value, key, member)
    {
        if ((*number)-- == 0)
            return json_object_set(value, key, by) == 0;
        if (replace(member, number, by))
            return true;
    }
    json_array_foreach(value, index, member)
    {
        if ((*number)-- == 0)
            return json_array_set(value, index, by) == 0;
        if (replace(member, number, by))
            return true;
    }
    return false;
}

static void test_mutations(void **state)
{
    static const char *const seeds[] = {
        AXES("\"x\":\"a\",\"y\":\"m\",\"series\":\"w\",\"log\":[\"x\"]"),
        "{\"rows\":[" ROW("\"a\":1,\"b\":2", "succeeded", "{\"m\":1}") "," ROW(
            "\"a\":2,\"b\":2", "succeeded",
            "{\"m\":2}") "," ROW("\"a\":2,\"b\":3", "succeeded",
                                 "{\"m\":7}") "],\"chart\":{\"x\":\"a\",\"y\":\"b\",\"z\":\"m\","
                                              "\"log\":\"z\"},\"title\":\"t\",\"units\":{\"m\":"
                                              "\"Pa\"},\"kind\":\"list\",\"width\":500}",
    };
    static const char *const replacements[] = {
        "null",  "true",  "0",           "-5",     "1e308",     "\"\"",
        "\"a\"", "\"b\"", "\"m\"",       "[]",     "{}",        "[[]]",
        "[{}]",  "1e18",  "\"\\u00e9\"", "\"xy\"", "{\"a\":1}", "\"\\u0001\\n\""};
    size_t drawn = 0, refused = 0;
    (void)state;
    for (size_t seed = 0; seed < sizeof seeds / sizeof seeds[0]; seed++) {
        bool more = true;
        for (size_t number = 0; more; number++) {
            for (size_t choice = 0; choice < sizeof replacements / sizeof *replacements; choice++) {
                json_t *specification = parse(seeds[seed]), *by = parse(replacements[choice]);
                size_t left = number;
                more = replace(specification, &left, by);
                if (more)
                    *(draw(specification) ? &drawn : &refused) += 1;
                json_decref(by);
                json_decref(specification);
            }
        }
    }
    assert_true(drawn > 100 && refused > 100);
}

/* Names of up to 1200 letters of one to four bytes, wherever they are cut. */
static void test_long_names(void **state)
{
    static const char *const letters[] = {"a", "\xcf\x86", "\xe2\x82\xac", "\xf0\x9f\x98\x80"};
    static const char *const words[] = {"x", "y", "z", "series", NULL};
    (void)state;
    for (size_t letter = 0; letter < 4; letter++) {
        for (size_t shift = 0; shift < 4; shift++) {
            char name[4 * 900 + 8] = "";
            json_t *row = parse(ROW("", "succeeded", "{}")), *chart = json_object();
            for (size_t index = 0; index < shift; index++)
                (void)strcat(name, "b");
            for (size_t index = 0; index < 900; index++)
                memcpy(name + shift + index * strlen(letters[letter]), letters[letter],
                       strlen(letters[letter]) + 1);
            for (size_t index = 0; words[index] != NULL; index++) {
                char longer[sizeof name + 8];
                const bool text = index == 3;
                (void)snprintf(longer, sizeof longer, "%.1s%s", words[index], name);
                (void)json_object_set_new(chart, words[index], json_string(longer));
                (void)json_object_set_new(
                    json_object_get(row, index == 2 ? "metrics" : "parameters"), longer,
                    text ? json_string(name) : json_integer(3));
            }
            json_t *specification = json_pack("{s:[O, O], s:O, s:s, s:{s:s}}", "rows", row, row,
                                              "chart", chart, "title", name, "units", "u", name);
            if (!draw(specification))
                fail_msg("letter %zu, shift %zu", letter, shift);
            (void)json_object_del(chart, "z");
            (void)json_object_set(chart, "x", json_object_get(chart, "series"));
            if (!draw(specification))
                fail_msg("lines, letter %zu, shift %zu", letter, shift);
            json_decref(specification);
            json_decref(chart);
            json_decref(row);
        }
    }
}

/* A long study: a thousand lines of ten, and more scattered points than are triangulated. */
static void test_many_rows(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        json_t *rows = json_array();
        for (int row = 0; row < 4000; row++)
            (void)json_array_append_new(
                rows, json_pack("{s:{s:f, s:f, s:i}, s:s, s:{s:f}}", "parameters", "a",
                                sqrt(row * 0.7), "b", (double)(row * 7919 % 4001), "c", row % 1000,
                                "state", "succeeded", "metrics", "m", (double)(row % 17)));
        json_t *specification =
            json_pack("{s:o, s:o}", "rows", rows, "chart",
                      parse(kind == 0 ? "{\"x\":\"a\",\"y\":\"m\",\"series\":"
                                        "\"c\"}"
                                      : "{\"x\":\"a\",\"y\":\"b\",\"z\":\"m\"}"));
        assert_true(draw(specification));
        json_decref(specification);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_are_counted), cmocka_unit_test(test_units),
        cmocka_unit_test(test_mistakes),         cmocka_unit_test(test_odd_numbers),
        cmocka_unit_test(test_mutations),        cmocka_unit_test(test_many_rows),
        cmocka_unit_test(test_long_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "event_parser.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

struct record {
    char text[512];
    int count, stop_after; /* events; 0: never stop */
};

static bool emit(void *context, const char *name, const char *id, const char *data)
{
    struct record *record = context;
    const size_t used = strlen(record->text);
    (void)snprintf(record->text + used, sizeof record->text - used, "%s|%s|%s;", name, id, data);
    record->count++;
    return record->count != record->stop_after;
}

static const char stream[] = ": comment\n\n"
                             "id: 12-0\nevent: state\ndata: {\"a\":1}\n\n"
                             "event:probe\r\ndata:one\r\ndata: two\r\n\r\n"
                             "unknown: x\nid: 13-2\ndata: z\n\n"
                             "event: empty\n\n"
                             "data: half";
static const char expected[] = "state|12-0|{\"a\":1};probe|12-0|one\ntwo;message|13-2|z;";

/* The events do not depend on how the bytes are cut into pieces. */
static void test_pieces(void **state)
{
    (void)state;
    for (size_t piece = 1; piece < sizeof stream; piece++) {
        struct record record = {0};
        struct event_parser parser = {.emit = emit, .context = &record};
        for (size_t begin = 0; begin < sizeof stream - 1; begin += piece) {
            const size_t left = sizeof stream - 1 - begin;
            assert_true(event_parser_feed(&parser, stream + begin, left < piece ? left : piece));
        }
        assert_string_equal(record.text, expected);
        assert_string_equal(parser.id, "13-2");
        event_parser_release(&parser);
    }
}

/* A connection that broke within an event leaves nothing of it to the next one. */
static void test_restart(void **state)
{
    (void)state;
    struct record record = {0};
    struct event_parser parser = {.emit = emit, .context = &record};
    assert_true(event_parser_feed(&parser, "id: 1-0\ndata: a\n\nid: 2-0\ndata: lo", 33));
    assert_string_equal(parser.id, "1-0"); /* the second one must come again */
    event_parser_restart(&parser);
    assert_true(event_parser_feed(&parser, "data: b\n\n", 9));
    assert_string_equal(record.text, "message|1-0|a;message|1-0|b;");
    event_parser_release(&parser);
}

static void test_stop(void **state)
{
    (void)state;
    struct record record = {.stop_after = 1};
    struct event_parser parser = {.emit = emit, .context = &record};
    assert_false(event_parser_feed(&parser, "data: a\n\ndata: b\n\n", 18));
    assert_string_equal(record.text, "message||a;");
    event_parser_release(&parser);
}

static void test_endless_line(void **state)
{
    (void)state;
    struct record record = {0};
    struct event_parser parser = {.emit = emit, .context = &record};
    static char block[1 << 20];
    bool fine = true;
    memset(block, 'x', sizeof block);
    for (int count = 0; count < 9 && fine; count++)
        fine = event_parser_feed(&parser, block, sizeof block);
    assert_false(fine);
    event_parser_release(&parser);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pieces),
        cmocka_unit_test(test_restart),
        cmocka_unit_test(test_stop),
        cmocka_unit_test(test_endless_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Events and their ids: whoever resumes behind any event gets exactly the rest. */
#include "event_stream.h"
#include "server_fixture.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char columns[] = "{\"columns\":[{\"name\":\"time\",\"unit\":\"s\"},"
                              "{\"name\":\"reaction.wall.force.x\",\"unit\":\"N\"},"
                              "{\"name\":\"energy.kinetic\",\"unit\":\"J\"},"
                              "{\"name\":\"probe.runout\",\"unit\":\"m\"}],\"row_bytes\":32}";

static void line(const char *folder, const char *text)
{
    fixture_write(folder, "events.ndjson", text, strlen(text), 1);
    fixture_write(folder, "events.ndjson", "\n", 1, 1);
}

/* Rows [first, end): time, 10 time, 100 time, 1000 time. */
static void rows(const char *folder, int first, int end)
{
    for (int row = first; row < end; row++) {
        double values[4] = {row, 10.0 * row, 100.0 * row, 1000.0 * row};
        fixture_write(folder, "history.bin", values, sizeof values, 1);
    }
}

/* A job that ran, crashed after row 5, went on from row 3, and succeeded with 6 rows. */
static char *story(void)
{
    char *folder = fixture_folder();
    fixture_write(folder, "history.json", columns, strlen(columns), 0);
    rows(folder, 0, 6);
    line(folder, "{\"event\":\"state\",\"attempt\":0,\"number\":1,\"state\":\"queued\"}");
    line(folder, "{\"event\":\"state\",\"attempt\":1,\"number\":2,\"state\":\"running\"}");
    line(folder, "{\"event\":\"started\",\"attempt\":1}");
    line(folder, "{\"event\":\"progress\",\"attempt\":1,\"step\":1}");
    line(folder, "{\"event\":\"history\",\"attempt\":1,\"rows\":2}");
    line(folder, "garbage");
    line(folder, "{\"event\":\"history\",\"attempt\":1,\"rows\":5}");
    line(folder, "{\"event\":\"state\",\"attempt\":1,\"number\":3,\"state\":\"queued\"}");
    line(folder, "{\"event\":\"state\",\"attempt\":2,\"number\":4,\"state\":\"running\"}");
    line(folder, "{\"event\":\"rewind\",\"attempt\":2,\"row\":3,\"time\":2,\"frame\":0}");
    line(folder, "{\"event\":\"progress\",\"attempt\":2,\"step\":2}");
    line(folder, "{\"event\":\"history\",\"attempt\":2,\"rows\":6}");
    line(folder, "{\"event\":\"frame\",\"attempt\":2,\"n\":0}");
    line(folder, "{\"event\":\"finished\",\"attempt\":2,\"metrics\":{}}");
    line(folder, "{\"event\":\"state\",\"attempt\":2,\"number\":5,\"state\":\"succeeded\"}");
    return folder;
}

/* Everything behind an id; free() it. */
static char *read_behind(const char *folder, struct event_id after)
{
    struct talus_error error = {0};
    struct event_stream stream;
    assert_int_equal(event_stream_open(&stream, folder, after, &error), TALUS_OK);
    while (event_stream_fill(&stream))
        continue;
    assert_true(stream.done);
    char *text = text_take(&stream.out);
    assert_non_null(text);
    event_stream_close(&stream);
    return text;
}

static void test_the_whole_story(void **state)
{
    static const char *const expected[] = {
        "event: state\ndata: {\"event\":\"state\",\"attempt\":0",
        "event: reaction\n",
        "{\"name\":\"reaction.wall.force.x\",\"time\":[0,1],\"value\":[0,10]}",
        "event: energy\ndata: {\"name\":\"energy.kinetic\",\"time\":[0,1],\"value\":[0,100]}",
        "event: probe\ndata: {\"name\":\"probe.runout\",\"time\":[0,1],\"value\":[0,1000]}",
        /* row 3 and 4 of the first attempt are void, only row 2 is told */
        "event: reaction\ndata: {\"name\":\"reaction.wall.force.x\",\"time\":[2],\"value\":[20]}",
        "event: rewind\n",
        "event: progress\ndata: {\"event\":\"progress\",\"attempt\":2,\"step\":2}",
        "\"time\":[3,4,5],\"value\":[30,40,50]}",
        "event: frame\n",
        "event: done\n",
    };
    (void)state;
    char *folder = story(), *text = read_behind(folder, (struct event_id){0});
    const char *place = text;
    assert_non_null(place);
    for (size_t index = 0; index < sizeof expected / sizeof expected[0]; index++) {
        const char *found = strstr(place, expected[index]);
        if (found == NULL)
            fail_msg("missing: %s in\n%s", expected[index], text);
        place = found == NULL ? place : found;
    }
    assert_null(strstr(text, "\"step\":1"));
    assert_null(strstr(text, "started"));
    assert_null(strstr(text, "finished"));
    assert_null(strstr(text, "garbage"));
    free(text);
    fixture_folder_remove(folder);
}

static void test_resume_behind_every_event(void **state)
{
    (void)state;
    char *folder = story(), *whole = read_behind(folder, (struct event_id){0});
    int event_count = 0;
    for (char *event = whole; *event != '\0'; event_count++) {
        struct event_id id;
        char id_text[64];
        char *end = strstr(event, "\n\n") + 2;
        assert_int_equal(sscanf(event, "id: %63s", id_text), 1);
        assert_true(event_id_parse(id_text, &id));
        char *rest = read_behind(folder, id);
        assert_string_equal(rest, end);
        free(rest);
        event = end;
    }
    assert_int_equal(event_count, 18);
    free(whole);
    fixture_folder_remove(folder);
}

static void test_ids(void **state)
{
    static const char *const bad[] = {"",     "x",    "1",     "-1-0",
                                      "1-",   "1-x",  "1-2-3", "+1-2",
                                      " 1-2", "1 -2", "0x1-2", "99999999999999999999-1"};
    struct event_id id;
    struct talus_error error = {0};
    struct event_stream stream;
    (void)state;
    assert_true(event_id_parse("120-3", &id));
    assert_true(id.offset == 120 && id.number == 3);
    for (size_t index = 0; index < sizeof bad / sizeof bad[0]; index++)
        assert_false(event_id_parse(bad[index], &id));
    char *folder = story();
    id = (struct event_id){.offset = 7, .number = 0};
    assert_int_equal(event_stream_open(&stream, folder, id, &error), TALUS_INVALID);
    assert_string_equal(error.code, "event_id");
    fixture_folder_remove(folder);
}

static void test_live_progress_is_all_told(void **state)
{
    struct talus_error error = {0};
    struct event_stream stream;
    (void)state;
    char *folder = fixture_folder();
    line(folder, "{\"event\":\"state\",\"attempt\":1,\"number\":1,\"state\":\"running\"}");
    line(folder, "{\"event\":\"progress\",\"attempt\":1,\"step\":1}");
    line(folder, "{\"event\":\"progress\",\"attempt\":1,\"step\":2}");
    assert_int_equal(event_stream_open(&stream, folder, (struct event_id){0}, &error), TALUS_OK);
    assert_false(event_stream_fill(&stream));
    assert_false(stream.done);
    assert_null(strstr(stream.out.data, "\"step\":1"));
    assert_non_null(strstr(stream.out.data, "\"step\":2"));
    line(folder, "{\"event\":\"progress\",\"attempt\":1,\"step\":3}");
    line(folder, "{\"event\":\"progress\",\"attempt\":1,\"step\":4}");
    assert_false(event_stream_fill(&stream));
    assert_non_null(strstr(stream.out.data, "\"step\":3"));
    assert_non_null(strstr(stream.out.data, "\"step\":4"));
    event_stream_close(&stream);
    fixture_folder_remove(folder);
}

static void test_long_histories_come_in_pieces(void **state)
{
    enum { ROWS = 3000 };
    struct talus_error error = {0};
    struct event_stream stream;
    (void)state;
    char *folder = fixture_folder();
    fixture_write(folder, "history.json", columns, strlen(columns), 0);
    rows(folder, 0, ROWS);
    line(folder, "{\"event\":\"history\",\"attempt\":1,\"rows\":3000}");
    line(folder, "{\"event\":\"state\",\"attempt\":1,\"number\":1,\"state\":\"succeeded\"}");
    assert_int_equal(event_stream_open(&stream, folder, (struct event_id){0}, &error), TALUS_OK);
    int row_count = 0, piece_count = 0;
    bool more = true;
    while (more) {
        more = event_stream_fill(&stream);
        assert_true(stream.out.length < 200000);
        for (char *place = stream.out.data; place != NULL && stream.out.length > 0;) {
            place = strstr(place, "force.x\",\"time\":[");
            if (place == NULL)
                break;
            place += strlen("force.x\",\"time\":[");
            char *end = strchr(place, ']');
            for (const char *number = place; number < end; number++)
                row_count += *number == ',';
            row_count++;
            piece_count++;
        }
        text_drop(&stream.out, stream.out.length);
    }
    assert_int_equal(row_count, ROWS);
    assert_int_equal(piece_count, 6);
    event_stream_close(&stream);
    fixture_folder_remove(folder);
}

static void test_gap(void **state)
{
    struct talus_error error = {0};
    struct event_stream stream;
    (void)state;
    char *folder = fixture_folder();
    line(folder, "{\"event\":\"state\",\"attempt\":1,\"number\":1,\"state\":\"running\"}");
    assert_int_equal(event_stream_open(&stream, folder, (struct event_id){0}, &error), TALUS_OK);
    assert_false(event_stream_fill(&stream));
    struct event_id last = stream.last;
    line(folder, "{\"event\":\"progress\",\"attempt\":1,\"step\":3}");
    line(folder, "{\"event\":\"state\",\"attempt\":1,\"number\":2,\"state\":\"queued\"}");
    assert_true(event_stream_backlog(&stream) > 0);
    text_drop(&stream.out, stream.out.length);
    event_stream_skip(&stream);
    char expected[64];
    (void)snprintf(expected, sizeof expected, "event: gap\ndata: {\"after\":\"%" PRId64 "-%" PRIu64,
                   last.offset, last.number);
    assert_null(strstr(stream.out.data, "progress"));
    assert_non_null(strstr(stream.out.data, "\"number\":2"));
    assert_non_null(strstr(stream.out.data, expected));
    assert_int_equal(event_stream_backlog(&stream), 0);
    event_stream_close(&stream);
    fixture_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_whole_story),
        cmocka_unit_test(test_resume_behind_every_event),
        cmocka_unit_test(test_ids),
        cmocka_unit_test(test_live_progress_is_all_told),
        cmocka_unit_test(test_long_histories_come_in_pieces),
        cmocka_unit_test(test_gap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

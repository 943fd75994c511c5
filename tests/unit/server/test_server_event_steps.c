/* SPDX-License-Identifier: Apache-2.0 */
/* Readers of one story that share what was read are told what each would have read alone. */
#include "event_steps.h"
#include "server_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { READERS = 4 };

static const char columns[] = "{\"columns\":[{\"name\":\"time\",\"unit\":\"s\"},"
                              "{\"name\":\"energy.kinetic\",\"unit\":\"J\"}],\"row_bytes\":16}";

/* A state line, then `rows` more rows of history and their line. */
static void grow(const char *folder, int *rows, int more)
{
    char line[160];
    for (int row = *rows; row < *rows + more; row++) {
        double values[2] = {row, 0.1 * row};
        fixture_write(folder, "history.bin", values, sizeof values, 1);
    }
    *rows += more;
    int length = snprintf(line, sizeof line,
                          "{\"event\":\"progress\",\"step\":%d}\n{\"event\":\"history\","
                          "\"rows\":%d}\n{\"event\":\"frame\",\"n\":%d}\n",
                          *rows, *rows, *rows);
    fixture_write(folder, "events.ndjson", line, (size_t)length, 1);
}

static void rewind_to(const char *folder, int *rows, int row)
{
    char line[64];
    int length = snprintf(line, sizeof line, "{\"event\":\"rewind\",\"row\":%d}\n", row);
    fixture_write(folder, "events.ndjson", line, (size_t)length, 1);
    *rows = row;
    double values[2] = {-1, -1};
    fixture_write(folder, "history.bin", values, sizeof values, 0); /* a new file */
    for (int more = 1; more < row; more++)
        fixture_write(folder, "history.bin", values, sizeof values, 1);
}

static void open_reader(struct event_stream *stream, const char *folder)
{
    struct talus_error error = {0};
    assert_int_equal(event_stream_open(stream, folder, (struct event_id){0}, &error), TALUS_OK);
}

/* What a reader that went through the same files alone has been told. */
static void expect_equal(const struct event_stream *shared, const struct event_stream *alone)
{
    assert_int_equal(shared->out.length, alone->out.length);
    if (alone->out.length > 0)
        assert_memory_equal(shared->out.data, alone->out.data, alone->out.length);
    assert_int_equal(shared->done, alone->done);
    assert_int_equal(shared->last.offset, alone->last.offset);
    assert_int_equal(shared->last.number, alone->last.number);
}

/* One look at all readers; reader 2 takes part in every second one only. */
static void look(struct event_stream *streams, struct event_stream *alone, int number)
{
    struct event_steps steps = {0};
    struct text none = {0};
    for (int reader = 0; reader < READERS; reader++) {
        if (reader == 2 && number % 2 == 1)
            continue;
        event_steps_fill(&steps, &streams[reader]);
        (void)event_stream_fill(&alone[reader]);
        expect_equal(&streams[reader], &alone[reader]);
        text_release(&streams[reader].out);
        text_release(&alone[reader].out);
        streams[reader].out = alone[reader].out = none;
    }
    event_steps_clear(&steps);
}

static void test_shared_as_alone(void **state)
{
    static const char end[] = "{\"event\":\"state\",\"number\":2,\"state\":\"succeeded\"}\n";
    struct event_stream streams[READERS], alone[READERS];
    int rows = 0;
    char *folder = fixture_folder();
    (void)state;
    fixture_write(folder, "history.json", columns, strlen(columns), 0);
    grow(folder, &rows, 3);
    for (int reader = 0; reader < READERS; reader++) {
        if (reader == 3)
            grow(folder, &rows, 2); /* comes later: has a replay of its own */
        open_reader(&streams[reader], folder);
        open_reader(&alone[reader], folder);
    }
    int number = 0;
    for (; number < 6; number++) {
        look(streams, alone, number);
        grow(folder, &rows, number == 3 ? 3000 : 2); /* more than one filling holds */
        if (number == 4)
            rewind_to(folder, &rows, 2);
    }
    fixture_write(folder, "events.ndjson", end, strlen(end), 1);
    for (; number < 20; number++)
        look(streams, alone, number);
    for (int reader = 0; reader < READERS; reader++) {
        assert_true(streams[reader].done);
        event_stream_close(&streams[reader]);
        event_stream_close(&alone[reader]);
    }
    fixture_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shared_as_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

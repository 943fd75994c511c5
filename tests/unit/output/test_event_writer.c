/* SPDX-License-Identifier: Apache-2.0 */
#include "scratch_folder.h"
#include "worker/event_writer.h"
#include "worker/frame_list.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static void lines_carry_event_time_and_attempt(void **state)
{
    char path[SCRATCH_PATH_SIZE], text[1024];
    struct event_writer writer;
    struct talus_error error = {.status = TALUS_OK};
    assert_int_equal(event_open(&writer, *state, &error), TALUS_OK);
    writer.attempt = 3;
    json_t *fields =
        json_pack("{s:o, s:o}", "good", event_number(0.5), "bad", event_number((double)NAN));
    assert_int_equal(event_write(&writer, PROTOCOL_PROGRESS, fields, &error), TALUS_OK);
    event_close(&writer);
    size_t length = scratch_read(scratch_path(path, *state, "events.ndjson"), text, sizeof text);
    assert_true(text[length - 1] == '\n');
    json_t *line = json_loads(text, 0, NULL);
    assert_string_equal(json_string_value(json_object_get(line, "event")), "progress");
    assert_int_equal(json_integer_value(json_object_get(line, "attempt")), 3);
    assert_int_equal(strlen(json_string_value(json_object_get(line, "at"))), 27);
    assert_true(json_is_null(json_object_get(line, "bad")));
    json_decref(line);
}

static void a_torn_line_is_cut(void **state)
{
    static const char *const torn[] = {"{\"event\":\"sta", "{", "{\"attempt\":9}"};
    char path[SCRATCH_PATH_SIZE], text[256];
    struct event_writer writer;
    struct talus_error error = {.status = TALUS_OK};
    scratch_path(path, *state, "events.ndjson");
    scratch_append(path, "{\"attempt\":1}\n{\"attempt\":4}\n");
    for (size_t index = 0; index < sizeof torn / sizeof torn[0]; index++) {
        scratch_append(path, torn[index]);
        assert_int_equal(event_open(&writer, *state, &error), TALUS_OK);
        assert_int_equal(writer.last_attempt, 4);
        event_close(&writer);
        (void)scratch_read(path, text, sizeof text);
        assert_string_equal(text, "{\"attempt\":1}\n{\"attempt\":4}\n");
    }
}

static void a_file_of_one_torn_line_becomes_empty(void **state)
{
    char path[SCRATCH_PATH_SIZE], text[64];
    struct event_writer writer;
    struct talus_error error = {.status = TALUS_OK};
    scratch_append(scratch_path(path, *state, "events.ndjson"), "{\"event\"");
    assert_int_equal(event_open(&writer, *state, &error), TALUS_OK);
    assert_int_equal(writer.last_attempt, 0);
    event_close(&writer);
    assert_int_equal(scratch_read(path, text, sizeof text), 0);
}

static void later_frames_are_removed(void **state)
{
    static const char *const names[] = {"frame_000000.hdf", "frame_000001.hdf", "frame_000002.hdf",
                                        "grid_000002.hdf", "frame_1000000.vtu"};
    static const char *const others[] = {"frames.pvd", "frame_x.hdf", "000003.hdf"};
    char path[SCRATCH_PATH_SIZE];
    struct talus_error error = {.status = TALUS_OK};
    for (size_t index = 0; index < 5; index++)
        scratch_append(scratch_path(path, *state, names[index]), "x");
    for (size_t index = 0; index < 3; index++)
        scratch_append(scratch_path(path, *state, others[index]), "x");
    assert_int_equal(frame_list_trim(*state, 2, &error), TALUS_OK);
    for (size_t index = 0; index < 5; index++)
        assert_int_equal(access(scratch_path(path, *state, names[index]), F_OK),
                         index < 2 ? 0 : -1);
    for (size_t index = 0; index < 3; index++)
        assert_int_equal(access(scratch_path(path, *state, others[index]), F_OK), 0);
}

static void a_list_of_frames_survives_a_checkpoint(void **state)
{
    struct frame_list list = {.count = 0}, copy = {.count = 0};
    struct talus_error error = {.status = TALUS_OK};
    (void)state;
    for (uint64_t index = 0; index < 200; index++) {
        struct frame_entry entry = {
            .time = 0.1 * (double)index, .step = index, .particles = 7, .bytes = 1u << 30};
        memset(entry.sha256, 'a', 64);
        assert_int_equal(frame_list_add(&list, &entry, &error), TALUS_OK);
    }
    json_t *array = frame_list_json(&list);
    char *text = json_dumps(array, 0);
    json_t *again = json_loads(text, 0, NULL);
    assert_int_equal(frame_list_read(&copy, again, &error), TALUS_OK);
    assert_int_equal(copy.count, list.count);
    for (size_t index = 0; index < list.count; index++) {
        assert_true(copy.entries[index].time == list.entries[index].time);
        assert_int_equal(copy.entries[index].bytes, list.entries[index].bytes);
        assert_string_equal(copy.entries[index].sha256, list.entries[index].sha256);
    }
    json_decref(array);
    json_decref(again);
    free(text);
    frame_list_release(&list);
    frame_list_release(&copy);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, scratch_folder_make, scratch_folder_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(lines_carry_event_time_and_attempt),     TEST(a_torn_line_is_cut),
        TEST(a_file_of_one_torn_line_becomes_empty),  TEST(later_frames_are_removed),
        TEST(a_list_of_frames_survives_a_checkpoint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

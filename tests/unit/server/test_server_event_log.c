/* SPDX-License-Identifier: Apache-2.0 */
#include "event_log.h"
#include "folder.h"
#include "server_fixture.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char events_file[] = "events.ndjson";

static enum talus_status change_cancel(struct job *job, void *context, struct talus_error *error)
{
    (void)context;
    return job_cancel(job, error);
}

static bool lines_note(char *line, size_t length, int64_t end, void *context)
{
    struct text *text = context;
    (void)end;
    assert_int_equal(strlen(line), length);
    text_print(text, "%s|", line);
    return true;
}

static void test_repair(void **state)
{
    static const char torn[] = "{\"event\":\"started\",\"attempt\":1}\n{\"event\":\"prog";
    struct talus_error error = {0};
    struct store *store;
    enum store_insert result;
    char existing[64];
    (void)state;
    char *folder = fixture_folder(), *path = folder_join(folder, "db.sqlite");
    struct job job = fixture_job("j");
    assert_int_equal(store_open(path, &store, &error), TALUS_OK);
    assert_int_equal(store_job_insert(store, &job, NULL, NULL, &result, existing, &error),
                     TALUS_OK);
    fixture_write(folder, events_file, torn, sizeof torn - 1, 0);
    assert_int_equal(event_log_last_number(folder), 0);
    assert_int_equal(event_log_repair(store, "j", folder, &error), TALUS_OK);
    assert_int_equal(event_log_last_number(folder), 1);
    assert_int_equal(store_job_change(store, "j", change_cancel, NULL, NULL, &error), TALUS_OK);
    assert_int_equal(event_log_repair(store, "j", folder, &error), TALUS_OK);
    assert_int_equal(event_log_repair(store, "j", folder, &error), TALUS_OK);
    assert_int_equal(event_log_last_number(folder), 2);
    struct event_tail tail = {.descriptor = -1};
    struct text lines = {0};
    assert_int_equal(event_tail_read(&tail, folder, lines_note, &lines, &error), TALUS_OK);
    assert_null(strstr(lines.data, "prog"));
    const char *queued = strstr(lines.data, "\"number\":1,\"state\":\"queued\"");
    const char *cancelled = strstr(lines.data, "\"number\":2,\"state\":\"cancelled\"");
    assert_true(queued != NULL && cancelled != NULL && queued < cancelled);
    assert_null(strstr(cancelled + 1, "\"number\""));
    event_tail_close(&tail);
    text_release(&lines);
    store_close(store);
    job_release(&job);
    free(path);
    fixture_folder_remove(folder);
}

static void test_tail_of_a_growing_file(void **state)
{
    struct talus_error error = {0};
    struct event_tail tail = {.descriptor = -1};
    struct text lines = {0};
    (void)state;
    char *folder = fixture_folder();
    assert_int_equal(event_tail_read(&tail, folder, lines_note, &lines, &error), TALUS_OK);
    fixture_write(folder, events_file, "one\ntw", 6, 0);
    assert_int_equal(event_tail_read(&tail, folder, lines_note, &lines, &error), TALUS_OK);
    assert_string_equal(lines.data, "one|");
    fixture_write(folder, events_file, "o\n", 2, 1);
    assert_int_equal(event_tail_read(&tail, folder, lines_note, &lines, &error), TALUS_OK);
    assert_string_equal(lines.data, "one|two|");
    assert_int_equal(tail.offset, 8);
    enum { LONG = 200000 };
    char *line = malloc(LONG);
    assert_non_null(line);
    memset(line, 'x', LONG);
    line[LONG - 1] = '\n';
    fixture_write(folder, events_file, line, LONG, 1);
    assert_int_equal(event_tail_read(&tail, folder, lines_note, &lines, &error), TALUS_OK);
    assert_int_equal(tail.offset, 8 + LONG);
    assert_int_equal(lines.length, 8 + LONG);
    free(line);
    event_tail_close(&tail);
    text_release(&lines);
    fixture_folder_remove(folder);
}

static void test_lock(void **state)
{
    (void)state;
    char *folder = fixture_folder();
    int first = event_log_lock(folder);
    assert_true(first >= 0);
    assert_int_equal(event_log_lock(folder), -1);
    assert_int_equal(errno, EWOULDBLOCK);
    assert_int_equal(close(first), 0);
    first = event_log_lock(folder);
    assert_true(first >= 0);
    assert_int_equal(close(first), 0);
    fixture_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_repair),
        cmocka_unit_test(test_tail_of_a_growing_file),
        cmocka_unit_test(test_lock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

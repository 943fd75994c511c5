/* SPDX-License-Identifier: Apache-2.0 */
#include "feed.h"
#include "folder.h"
#include "server_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct fixture {
    char *folder;
    struct store *store;
    struct feed *feed;
};

static void fixture_open(struct fixture *fixture)
{
    struct talus_error error = {0};
    fixture->folder = fixture_folder();
    char *path = folder_join(fixture->folder, "store");
    assert_int_equal(store_open(path, &fixture->store, &error), TALUS_OK);
    assert_int_equal(feed_create(&fixture->feed, fixture->store, &error), TALUS_OK);
    free(path);
}

static void fixture_close(struct fixture *fixture)
{
    feed_destroy(fixture->feed);
    store_close(fixture->store);
    fixture_folder_remove(fixture->folder);
}

static void jobs_insert(struct fixture *fixture, int first, int end)
{
    struct talus_error error = {0};
    enum store_insert result;
    char id[64], existing[64];
    for (int number = first; number < end; number++) {
        (void)snprintf(id, sizeof id, "j%06d", number);
        struct job job = fixture_job(id);
        assert_int_equal(
            store_job_insert(fixture->store, &job, NULL, NULL, &result, existing, &error),
            TALUS_OK);
        job_release(&job);
    }
}

static size_t count_of(const struct text *text, const char *what)
{
    size_t count = 0;
    for (const char *at = text->data; at != NULL && (at = strstr(at, what)) != NULL; at++)
        count++;
    return count;
}

/* Reads until nothing comes; returns how many states were told. */
static size_t reader_drain(struct feed_reader *reader)
{
    size_t count = 0, before;
    do {
        feed_reader_fill(reader);
        assert_false(reader->out.failed);
        before = count_of(&reader->out, "event: state");
        count += before;
        text_release(&reader->out);
    } while (before > 0);
    return count;
}

static void test_everybody_gets_everything_once(void **state)
{
    struct fixture fixture;
    struct feed_reader early, late;
    (void)state;
    fixture_open(&fixture);
    feed_reader_open(&early, fixture.feed, 0);
    /* More than are kept in memory. */
    jobs_insert(&fixture, 0, 1100);
    feed_refresh(fixture.feed);
    jobs_insert(&fixture, 1100, 1500);
    feed_refresh(fixture.feed);
    assert_int_equal(reader_drain(&early), 1500);
    feed_reader_open(&late, fixture.feed, 700);
    assert_int_equal(reader_drain(&late), 800);
    jobs_insert(&fixture, 1500, 1501);
    feed_refresh(fixture.feed);
    feed_reader_fill(&early);
    assert_non_null(strstr(early.out.data, "id: 1501\nevent: state\ndata: {\"job\":\"j001500\""));
    text_release(&early.out);
    assert_int_equal(feed_last(fixture.feed), 1501);
    fixture_close(&fixture);
}

static void test_progress_is_for_those_who_listen(void **state)
{
    struct fixture fixture;
    struct feed_reader listener, late, behind;
    json_t *progress = json_pack("{s:i}", "step", 7);
    (void)state;
    fixture_open(&fixture);
    jobs_insert(&fixture, 0, 1);
    feed_refresh(fixture.feed);
    feed_reader_open(&listener, fixture.feed, 1);
    feed_reader_open(&behind, fixture.feed, 0);
    jobs_insert(&fixture, 1, 3);
    feed_progress(fixture.feed, "j000000", progress);
    feed_reader_open(&late, fixture.feed, 1);
    feed_reader_fill(&listener);
    feed_reader_fill(&late);
    assert_int_equal(
        count_of(&listener.out, "event: progress\ndata: {\"job\":\"j000000\",\"step\":7}"), 1);
    assert_int_equal(count_of(&late.out, "event: progress"), 0);
    text_release(&listener.out);
    feed_reader_fill(&listener);
    assert_int_equal(count_of(&listener.out, "event: progress"), 0);
    feed_reader_close(&listener);
    feed_reader_close(&late);
    feed_reader_close(&behind);
    json_decref(progress);
    fixture_close(&fixture);
}

static void test_a_gap_says_what_was_missed(void **state)
{
    struct fixture fixture;
    struct feed_reader reader;
    (void)state;
    fixture_open(&fixture);
    feed_reader_open(&reader, fixture.feed, 0);
    jobs_insert(&fixture, 0, 40);
    feed_refresh(fixture.feed);
    assert_true(feed_reader_backlog(&reader) >= 40 * 100);
    feed_reader_skip(&reader);
    assert_string_equal(reader.out.data, "id: 40\nevent: gap\ndata: {\"after\":\"0\"}\n\n");
    text_release(&reader.out);
    assert_int_equal(feed_reader_backlog(&reader), 0);
    assert_int_equal(reader_drain(&reader), 0);
    fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_everybody_gets_everything_once),
        cmocka_unit_test(test_progress_is_for_those_who_listen),
        cmocka_unit_test(test_a_gap_says_what_was_missed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

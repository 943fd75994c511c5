/* SPDX-License-Identifier: Apache-2.0 */
#include "server_fixture.h"
#include "studies/study_store.h"
#include "text.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static enum store_insert insert(struct store *store, const char *id, const char *key,
                                const char *body, int64_t queue_limit, char existing[64])
{
    struct talus_error error = {0};
    enum store_insert result;
    struct job job = fixture_job(id);
    const struct store_key both = {.owner = "", .key = key, .body = body};
    assert_int_equal(store_job_insert(store, &job, key == NULL ? NULL : &both,
                                      &(struct store_limits){.queued = queue_limit}, &result,
                                      existing, &error),
                     TALUS_OK);
    job_release(&job);
    return result;
}

static void study_insert(struct store *store, char *id)
{
    struct talus_error error = {0};
    enum store_insert result;
    char existing[64];
    const struct study study = {.id = id, .created_at = (char[]){"2026-01-01T00:00:00.000Z"}};
    json_t *rows = json_pack("[{s:{}, s:{}}]", "parameters", "set");
    assert_int_equal(study_store_insert(store, &study, rows, NULL, &result, existing, &error),
                     TALUS_OK);
    json_decref(rows);
}

static void test_every_column_survives(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    enum store_insert result;
    char existing[64];
    struct job job = fixture_job("j1"), read = {0};
    int64_t number = 3;
#define JOB_TEXT(name) assert_int_equal(job_text_set(&job.name, "[\"" #name "\"]", &error), 0);
#define JOB_INTEGER(name) job.name = number++;
#define JOB_REAL(name) job.name = (double)number++ + 0.5;
#include "job_columns.def"
#undef JOB_TEXT
#undef JOB_INTEGER
#undef JOB_REAL
    job.state = JOB_FAILED;
    job.deleting = 0;
    /* A job of a study takes a place that waits for it. */
    job.study_row = 0;
    study_insert(fixture->store, job.study);
    assert_int_equal(store_job_insert(fixture->store, &job, NULL, NULL, &result, existing, &error),
                     TALUS_OK);
    store_close(fixture->store);
    assert_int_equal(store_open(fixture->path, &fixture->store, &error), TALUS_OK);
    assert_int_equal(store_job_read(fixture->store, "j1", &read, &error), TALUS_OK);
    assert_string_equal(read.id, "j1");
#define JOB_TEXT(name) assert_string_equal(read.name, "[\"" #name "\"]");
#define JOB_INTEGER(name) assert_int_equal(read.name, job.name);
#define JOB_REAL(name) assert_true(read.name == job.name);
#include "job_columns.def"
#undef JOB_TEXT
#undef JOB_INTEGER
#undef JOB_REAL
    job_release(&job);
    job_release(&read);
}

static void test_keys(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    struct job job = {0};
    enum store_insert result;
    char existing[64] = "";
    assert_int_equal(insert(fixture->store, "j1", "k", "b", 0, existing), STORE_INSERTED);
    assert_int_equal(insert(fixture->store, "j2", "k", "b", 0, existing), STORE_REPLAYED);
    assert_string_equal(existing, "j1");
    assert_int_equal(insert(fixture->store, "j3", "k", "other", 0, existing), STORE_OTHER_BODY);
    assert_int_equal(store_job_read(fixture->store, "j2", &job, &error), TALUS_INVALID);
    assert_string_equal(error.code, "not_found");
    const struct store_key key = {.owner = "", .key = "k", .body = "b"},
                           unknown = {.owner = "", .key = "x", .body = "b"};
    assert_int_equal(store_key_find(fixture->store, &key, &result, existing, &error), TALUS_OK);
    assert_int_equal(result, STORE_REPLAYED);
    assert_int_equal(store_key_find(fixture->store, &unknown, &result, existing, &error), TALUS_OK);
    assert_int_equal(result, STORE_INSERTED);
    assert_int_equal(store_job_remove(fixture->store, "j1", &error), TALUS_OK);
    assert_int_equal(insert(fixture->store, "j4", "k", "other", 0, existing), STORE_INSERTED);
}

static void test_queue_limit(void **state)
{
    struct store_fixture *fixture = *state;
    char existing[64];
    assert_int_equal(insert(fixture->store, "j1", NULL, NULL, 2, existing), STORE_INSERTED);
    assert_int_equal(insert(fixture->store, "j2", NULL, NULL, 2, existing), STORE_INSERTED);
    assert_int_equal(insert(fixture->store, "j3", NULL, NULL, 2, existing), STORE_QUEUE_FULL);
}

static enum talus_status change_cancel(struct job *job, void *context, struct talus_error *error)
{
    (void)context;
    return job_cancel(job, error);
}

static enum talus_status change_fail(struct job *job, void *context, struct talus_error *error)
{
    (void)context;
    job->priority = 99;
    return talus_error_set(error, TALUS_LIMIT, "state", "", "no");
}

static enum talus_status change_delete(struct job *job, void *context, struct talus_error *error)
{
    (void)context;
    return job_mark_deleted(job, error);
}

static enum talus_status transition_note(const struct store_transition *transition, void *context,
                                         struct talus_error *error)
{
    (void)error;
    text_print(context, "%d %s;", (int)transition->number, transition->state);
    return TALUS_OK;
}

static void test_changes(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    struct job job = {0};
    char existing[64];
    struct text story = {0};
    assert_int_equal(insert(fixture->store, "j1", "k", "b", 0, existing), STORE_INSERTED);
    assert_int_equal(store_job_change(fixture->store, "j1", change_fail, NULL, NULL, &error),
                     TALUS_LIMIT);
    assert_int_equal(store_job_read(fixture->store, "j1", &job, &error), TALUS_OK);
    assert_int_equal(job.priority, 0);
    int64_t revision = job.revision;
    job_release(&job);
    assert_int_equal(store_job_change(fixture->store, "j1", change_cancel, NULL, &job, &error),
                     TALUS_OK);
    assert_int_equal(job.state, JOB_CANCELLED);
    assert_int_equal(job.revision, revision + 1);
    job_release(&job);
    assert_int_equal(store_transitions(fixture->store, "j1", 0, transition_note, &story, &error),
                     TALUS_OK);
    assert_string_equal(story.data, "1 queued;2 cancelled;");
    text_release(&story);
    assert_int_equal(store_transitions(fixture->store, "j1", 1, transition_note, &story, &error),
                     TALUS_OK);
    assert_string_equal(story.data, "2 cancelled;");
    text_release(&story);
    assert_int_equal(store_job_change(fixture->store, "j1", change_delete, NULL, NULL, &error),
                     TALUS_OK);
    assert_int_equal(store_job_read(fixture->store, "j1", &job, &error), TALUS_INVALID);
    assert_int_equal(insert(fixture->store, "j2", "k", "other", 0, existing), STORE_INSERTED);
}

static bool id_note(const struct job *job, void *context)
{
    text_print(context, "%s ", job->id);
    return true;
}

static void expect_list(struct store *store, struct store_filter filter, const char *expected)
{
    struct talus_error error = {0};
    struct text ids = {0};
    text_add_string(&ids, "");
    assert_int_equal(store_job_list(store, &filter, id_note, &ids, &error), TALUS_OK);
    assert_string_equal(ids.data, expected);
    text_release(&ids);
}

static void test_lists(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    enum store_insert result;
    char existing[64];
    static const char *const ids[] = {"j1", "j2", "j3"};
    for (size_t index = 0; index < 3; index++) {
        struct job job = fixture_job(ids[index]);
        job.priority = index == 1 ? 5 : 0;
        assert_int_equal(
            job_text_set(&job.labels, index == 2 ? "{\"a\\\"b\":\"c:d\"}" : "{}", &error),
            TALUS_OK);
        assert_int_equal(
            store_job_insert(fixture->store, &job, NULL, NULL, &result, existing, &error),
            TALUS_OK);
        job_release(&job);
    }
    assert_int_equal(store_job_change(fixture->store, "j1", change_cancel, NULL, NULL, &error),
                     TALUS_OK);
    const enum job_state all = JOB_STATE_COUNT;
    expect_list(fixture->store, (struct store_filter){.state = all}, "j3 j2 j1 ");
    expect_list(fixture->store, (struct store_filter){.state = all, .limit = 2}, "j3 j2 ");
    expect_list(fixture->store, (struct store_filter){.state = all, .before = "j3"}, "j2 j1 ");
    expect_list(fixture->store, (struct store_filter){.state = JOB_CANCELLED}, "j1 ");
    expect_list(fixture->store, (struct store_filter){.state = JOB_QUEUED, .by_queue = true},
                "j2 j3 ");
    expect_list(fixture->store,
                (struct store_filter){.state = all, .labels = {{"a\"b", "c:d"}}, .label_count = 1},
                "j3 ");
    expect_list(fixture->store,
                (struct store_filter){.state = all, .labels = {{"a", "c"}}, .label_count = 1}, "");
}

enum { WRITERS = 8, WRITES = 10 };

struct writer {
    struct store *store;
    int number;
    int failures;
};

static void *writer_main(void *argument)
{
    struct writer *writer = argument;
    for (int index = 0; index < WRITES; index++) {
        struct talus_error error = {0};
        struct job job = {.threads = 1};
        enum store_insert result;
        char id[32], existing[64];
        (void)snprintf(id, sizeof id, "j%d-%d", writer->number, index);
        if (job_text_set(&job.id, id, &error) != TALUS_OK || job_enter(&job, &error) != TALUS_OK ||
            store_job_insert(writer->store, &job, NULL, NULL, &result, existing, &error) !=
                TALUS_OK)
            writer->failures++;
        job_release(&job);
    }
    return NULL;
}

static bool count_one(const struct job *job, void *context)
{
    (void)job;
    ++*(int *)context;
    return true;
}

static void test_writers_at_once(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    pthread_t threads[WRITERS];
    struct writer writers[WRITERS];
    int count = 0;
    for (int index = 0; index < WRITERS; index++) {
        writers[index] = (struct writer){.store = fixture->store, .number = index};
        assert_int_equal(pthread_create(&threads[index], NULL, writer_main, &writers[index]), 0);
    }
    for (int index = 0; index < WRITERS; index++) {
        assert_int_equal(pthread_join(threads[index], NULL), 0);
        assert_int_equal(writers[index].failures, 0);
    }
    const struct store_filter filter = {.state = JOB_STATE_COUNT};
    assert_int_equal(store_job_list(fixture->store, &filter, count_one, &count, &error), TALUS_OK);
    assert_int_equal(count, WRITERS * WRITES);
    assert_true(store_healthy(fixture->store));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        STORE_TEST(test_every_column_survives),
        STORE_TEST(test_keys),
        STORE_TEST(test_queue_limit),
        STORE_TEST(test_changes),
        STORE_TEST(test_lists),
        STORE_TEST(test_writers_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

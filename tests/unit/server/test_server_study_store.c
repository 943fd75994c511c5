/* SPDX-License-Identifier: Apache-2.0 */
#include "server_fixture.h"
#include "studies/study_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *rows_make(size_t count)
{
    json_t *rows = json_array();
    for (size_t index = 0; index < count; index++)
        (void)json_array_append_new(rows, json_pack("{s:{s:i}, s:{s:i}}", "parameters", "a",
                                                    (int)index, "set", "/duration", (int)index));
    return rows;
}

static enum store_insert insert(struct store *store, const char *id, size_t row_count,
                                const struct store_key *key, char existing[64])
{
    struct talus_error error = {0};
    enum store_insert result;
    json_t *rows = rows_make(row_count);
    const struct study study = {.id = (char *)(uintptr_t)id,
                                .name = (char[]){"a study"},
                                .created_at = (char[]){"2026-01-01T00:00:00.000Z"},
                                .wanted = (char[]){"[\"steps\"]"},
                                .scene = (char[]){"{}"},
                                .design = (char[]){"{\"grid\":{}}"},
                                .rows_expected = (int64_t)row_count,
                                .revision = 1};
    assert_int_equal(study_store_insert(store, &study, rows, key, &result, existing, &error),
                     TALUS_OK);
    json_decref(rows);
    return result;
}

static struct study read_study(struct store *store, const char *id)
{
    struct talus_error error = {0};
    struct study study = {0};
    assert_int_equal(study_store_read(store, id, true, &study, &error), TALUS_OK);
    return study;
}

/* A job of a row, in the queue. */
static enum talus_status job_enters(struct store *store, const char *id, const char *study,
                                    int64_t row, struct talus_error *error)
{
    char existing[64];
    enum store_insert result;
    struct job job = fixture_job(id);
    job.study = strdup(study);
    job.study_row = row;
    enum talus_status status = store_job_insert(store, &job, NULL, NULL, &result, existing, error);
    job_release(&job);
    return status;
}

static enum talus_status begin(struct job *job, void *context, struct talus_error *error)
{
    (void)context;
    return job_begin(job, "boot", error);
}

static enum talus_status finish(struct job *job, void *context, struct talus_error *error)
{
    return job_finish(job, context, error);
}

static void job_ends(struct store *store, const char *id, enum job_end end)
{
    struct talus_error error = {0};
    json_t *metrics = json_pack("{s:i, s:i}", "steps", 7, "particles", 64);
    json_t *receipt = json_pack("{s:s}", "build", "b1");
    struct job_outcome outcome = {.end = end,
                                  .reason = end == JOB_END_FAILED ? "unstable" : NULL,
                                  .metrics = metrics,
                                  .receipt = receipt};
    assert_int_equal(store_job_change(store, id, begin, NULL, NULL, &error), TALUS_OK);
    assert_int_equal(store_job_change(store, id, finish, &outcome, NULL, &error), TALUS_OK);
    json_decref(metrics);
    json_decref(receipt);
}

struct rows_seen {
    size_t count;
    enum row_state states[8];
    char metrics[8][64], jobs[8][32];
};

static bool row_see(const struct study_row *row, void *context)
{
    struct rows_seen *seen = context;
    assert_true(row->number < 8);
    seen->states[row->number] = row->state;
    (void)snprintf(seen->metrics[row->number], sizeof seen->metrics[0], "%s",
                   row->metrics == NULL ? "" : row->metrics);
    (void)snprintf(seen->jobs[row->number], sizeof seen->jobs[0], "%s",
                   row->job == NULL ? "" : row->job);
    seen->count++;
    return true;
}

static struct rows_seen rows_of(struct store *store, const char *id)
{
    struct talus_error error = {0};
    struct rows_seen seen = {0};
    const struct row_filter filter = {.state = ROW_STATE_COUNT};
    assert_int_equal(study_store_rows(store, id, &filter, row_see, &seen, &error), TALUS_OK);
    return seen;
}

static void test_rows_follow_their_jobs(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    char existing[64];
    assert_int_equal(insert(fixture->store, "s1", 3, NULL, existing), STORE_INSERTED);
    struct study study = read_study(fixture->store, "s1");
    assert_int_equal(study.counts[ROW_WAITING], 3);
    assert_int_equal(study.row_count, 3);
    study_release(&study);
    assert_int_equal(job_enters(fixture->store, "j1", "s1", 0, &error), TALUS_OK);
    assert_int_equal(job_enters(fixture->store, "j2", "s1", 2, &error), TALUS_OK);
    study = read_study(fixture->store, "s1");
    assert_int_equal(study.counts[ROW_WAITING], 1);
    assert_int_equal(study.counts[ROW_QUEUED], 2);
    study_release(&study);
    job_ends(fixture->store, "j1", JOB_END_SUCCEEDED);
    job_ends(fixture->store, "j2", JOB_END_FAILED);
    study = read_study(fixture->store, "s1");
    assert_int_equal(study.counts[ROW_SUCCEEDED], 1);
    assert_int_equal(study.counts[ROW_FAILED], 1);
    assert_int_equal(study_active_count(&study), 0);
    assert_int_equal(study_ended_count(&study), 2);
    study_release(&study);
    const struct rows_seen seen = rows_of(fixture->store, "s1");
    assert_int_equal(seen.count, 3);
    assert_int_equal(seen.states[0], ROW_SUCCEEDED);
    assert_int_equal(seen.states[1], ROW_WAITING);
    assert_int_equal(seen.states[2], ROW_FAILED);
    assert_string_equal(seen.metrics[0], "{\"steps\":7}");
    assert_string_equal(seen.jobs[0], "j1");
}

static void test_a_row_becomes_one_job(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    struct job job = {0};
    char existing[64];
    (void)insert(fixture->store, "s1", 2, NULL, existing);
    assert_int_equal(job_enters(fixture->store, "j1", "s1", 0, &error), TALUS_OK);
    assert_int_equal(job_enters(fixture->store, "j2", "s1", 0, &error), TALUS_LIMIT);
    assert_string_equal(error.code, "state");
    assert_int_equal(store_job_read(fixture->store, "j2", &job, &error), TALUS_INVALID);
    const struct row_end end = {
        .study = "s1", .number = 0, .state = ROW_FAILED, .detail = "no such scene"};
    assert_int_equal(study_store_row_end(fixture->store, &end, &error), TALUS_LIMIT);
}

static void test_a_row_shows_another_job(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    char existing[64];
    (void)insert(fixture->store, "s1", 2, NULL, existing);
    (void)insert(fixture->store, "s2", 1, NULL, existing);
    (void)job_enters(fixture->store, "j1", "s2", 0, &error);
    job_ends(fixture->store, "j1", JOB_END_SUCCEEDED);
    const struct row_end end = {.study = "s1",
                                .number = 1,
                                .state = ROW_SUCCEEDED,
                                .job = "j1",
                                .metrics = "{\"steps\":7,\"time\":1}"};
    assert_int_equal(study_store_row_end(fixture->store, &end, &error), TALUS_OK);
    struct study study = read_study(fixture->store, "s1");
    assert_int_equal(study.counts[ROW_SUCCEEDED], 1);
    assert_int_equal(study.reused, 1);
    study_release(&study);
    json_t *own = NULL;
    assert_int_equal(study_store_jobs(fixture->store, "s1", &own, &error), TALUS_OK);
    assert_int_equal(json_array_size(own), 0);
    json_decref(own);
    /* The job goes; what the row showed stays. */
    assert_int_equal(store_job_remove(fixture->store, "j1", &error), TALUS_OK);
    const struct rows_seen seen = rows_of(fixture->store, "s1");
    assert_string_equal(seen.metrics[1], "{\"steps\":7}");
    assert_string_equal(seen.jobs[1], "");
}

static enum talus_status cancel(struct study *study, struct study_change *change,
                                struct talus_error *error)
{
    (void)error;
    study->cancel_requested = 1;
    study->state = STUDY_CANCELLED;
    change->cancel_waiting = true;
    return TALUS_OK;
}

struct transitions_seen {
    size_t count;
    int64_t last;
    char text[512];
};

static bool transition_see(const struct study_transition *transition, void *context)
{
    struct transitions_seen *seen = context;
    assert_true(transition->row > seen->last);
    seen->last = transition->row;
    seen->count++;
    size_t length = strlen(seen->text);
    (void)snprintf(seen->text + length, sizeof seen->text - length, "%d:%s ",
                   (int)transition->number, transition->state);
    return true;
}

static bool change_see(const char *id, void *context)
{
    (void)id;
    (*(size_t *)context)++;
    return true;
}

static void test_transitions_share_one_numbering(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    struct transitions_seen seen = {0};
    struct study_change change = {.apply = cancel};
    char existing[64];
    (void)insert(fixture->store, "s1", 3, NULL, existing);
    (void)job_enters(fixture->store, "j1", "s1", 0, &error);
    job_ends(fixture->store, "j1", JOB_END_SUCCEEDED);
    assert_int_equal(study_store_change(fixture->store, "s1", &change, NULL, &error), TALUS_OK);
    assert_int_equal(
        study_store_transitions(fixture->store, "s1", 0, transition_see, &seen, &error), TALUS_OK);
    assert_string_equal(seen.text, "-1:running 0:queued 0:running 0:succeeded 1:cancelled "
                                   "2:cancelled -1:cancelled ");
    /* 7 of the study, 3 of the job */
    assert_int_equal(seen.last, 10);
    struct study study = read_study(fixture->store, "s1");
    assert_int_equal(study.counts[ROW_CANCELLED], 2);
    assert_int_equal(study.counts[ROW_WAITING], 0);
    study_release(&study);
    int64_t after = 0;
    size_t count = 0;
    (void)insert(fixture->store, "s2", 1, NULL, existing);
    assert_int_equal(study_store_changes(fixture->store, &after, change_see, &count, &error),
                     TALUS_OK);
    assert_int_equal(count, 2);
    assert_int_equal(after, 11);
    count = 0;
    assert_int_equal(study_store_changes(fixture->store, &after, change_see, &count, &error),
                     TALUS_OK);
    assert_int_equal(count, 0);
}

static enum talus_status append(struct study *study, struct study_change *change,
                                struct talus_error *error)
{
    (void)study;
    (void)error;
    change->rows = change->context;
    return TALUS_OK;
}

static void test_rows_are_appended(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    struct study study = {0};
    char existing[64];
    json_t *rows = rows_make(2);
    struct study_change change = {.apply = append, .context = rows};
    (void)insert(fixture->store, "s1", 2, NULL, existing);
    assert_int_equal(study_store_change(fixture->store, "s1", &change, &study, &error), TALUS_OK);
    assert_int_equal(study.row_count, 4);
    assert_int_equal(study.counts[ROW_WAITING], 4);
    assert_int_equal(rows_of(fixture->store, "s1").count, 4);
    study_release(&study);
    json_decref(rows);
}

static void test_keys_and_removal(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    char existing[64];
    const struct store_key key = {.owner = "", .key = "k", .body = "b"};
    const struct store_key other = {.owner = "", .key = "k", .body = "c"};
    assert_int_equal(insert(fixture->store, "s1", 1, &key, existing), STORE_INSERTED);
    assert_int_equal(insert(fixture->store, "s2", 1, &key, existing), STORE_REPLAYED);
    assert_string_equal(existing, "s1");
    assert_int_equal(insert(fixture->store, "s3", 1, &other, existing), STORE_OTHER_BODY);
    struct study study = {0};
    assert_int_equal(study_store_read(fixture->store, "s2", false, &study, &error), TALUS_INVALID);
    assert_int_equal(study_store_remove(fixture->store, "s1", &error), TALUS_OK);
    assert_int_equal(rows_of(fixture->store, "s1").count, 0);
    assert_int_equal(insert(fixture->store, "s4", 1, &key, existing), STORE_INSERTED);
}

static void test_finished_jobs_are_found(void **state)
{
    struct store_fixture *fixture = *state;
    struct talus_error error = {0};
    struct job job = fixture_job("j1");
    enum store_insert result;
    char existing[64], found[64];
    job.scene_hash = strdup("h1");
    assert_int_equal(store_job_insert(fixture->store, &job, NULL, NULL, &result, existing, &error),
                     TALUS_OK);
    job_release(&job);
    assert_int_equal(store_job_find_finished(fixture->store, "h1", "b1", found, &error), TALUS_OK);
    assert_string_equal(found, "");
    job_ends(fixture->store, "j1", JOB_END_SUCCEEDED);
    assert_int_equal(store_job_find_finished(fixture->store, "h1", "b1", found, &error), TALUS_OK);
    assert_string_equal(found, "j1");
    assert_int_equal(store_job_find_finished(fixture->store, "h1", "b2", found, &error), TALUS_OK);
    assert_string_equal(found, "");
    assert_int_equal(store_job_find_finished(fixture->store, "h2", "b1", found, &error), TALUS_OK);
    assert_string_equal(found, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        STORE_TEST(test_rows_follow_their_jobs),  STORE_TEST(test_a_row_becomes_one_job),
        STORE_TEST(test_a_row_shows_another_job), STORE_TEST(test_transitions_share_one_numbering),
        STORE_TEST(test_rows_are_appended),       STORE_TEST(test_keys_and_removal),
        STORE_TEST(test_finished_jobs_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

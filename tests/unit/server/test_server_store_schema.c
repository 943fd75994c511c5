/* SPDX-License-Identifier: Apache-2.0 */
/* Databases of older daemons are brought up to date, those of newer ones are left alone. */
#include "server_fixture.h"

#include "folder.h"
#include "store.h"

#include <sqlite3.h>
#include <stdlib.h>

/* As the first format had it, with a job and its key. */
static const char format_1[] =
    "CREATE TABLE jobs (id TEXT PRIMARY KEY, name TEXT, labels TEXT, priority INTEGER NOT NULL,"
    " threads INTEGER NOT NULL, wall_limit REAL NOT NULL, memory_limit INTEGER NOT NULL,"
    " disk_limit INTEGER NOT NULL, retries INTEGER NOT NULL, state INTEGER NOT NULL, reason TEXT,"
    " detail TEXT, cancel_requested INTEGER NOT NULL, deleting INTEGER NOT NULL,"
    " revision INTEGER NOT NULL, transition_count INTEGER NOT NULL, changed_at TEXT,"
    " attempt INTEGER NOT NULL, crash_count INTEGER NOT NULL, wall_used REAL NOT NULL,"
    " attempt_started REAL NOT NULL, boot TEXT, created_at TEXT, started_at TEXT,"
    " finished_at TEXT, attempts TEXT, progress TEXT, forecast TEXT, advice TEXT, warnings TEXT,"
    " metrics TEXT, receipt TEXT, scene_hash TEXT) WITHOUT ROWID;"
    "CREATE INDEX jobs_by_state ON jobs (state, priority DESC, id);"
    "CREATE TABLE transitions (row INTEGER PRIMARY KEY AUTOINCREMENT,"
    " job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE, number INTEGER NOT NULL,"
    " at TEXT NOT NULL, state TEXT NOT NULL, attempt INTEGER NOT NULL, reason TEXT, detail TEXT,"
    " UNIQUE (job, number));"
    "CREATE TABLE idempotency (key TEXT NOT NULL, owner TEXT NOT NULL, body TEXT NOT NULL,"
    " job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE, PRIMARY KEY (owner, key))"
    " WITHOUT ROWID;"
    "CREATE INDEX idempotency_by_job ON idempotency (job);"
    "INSERT INTO jobs VALUES ('j1', 'first', '{\"site\":\"north\"}', 7, 1, 0.5, 0, 0, 2, 0, NULL, "
    "NULL, 0, 0, 3, 1,"
    " NULL, 0, 0, 0.25, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 'h');"
    "INSERT INTO idempotency VALUES ('k', '', 'b', 'j1');"
    "PRAGMA user_version = 1;";

static char *database_make(const char *folder, const char *sql)
{
    sqlite3 *database = NULL;
    char *path = folder_join(folder, "store");
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    assert_int_equal(sqlite3_exec(database, sql, NULL, NULL, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_close(database), SQLITE_OK);
    return path;
}

static bool job_count(const struct job *job, void *context)
{
    (void)job;
    ++*(int *)context;
    return true;
}

static void test_format_1_is_migrated(void **state)
{
    const struct store_key key = {.owner = "", .key = "k", .body = "b"};
    struct talus_error error = {0};
    struct store *store = NULL;
    struct job job = {0};
    enum store_insert result;
    const struct store_filter labelled = {
        .state = JOB_STATE_COUNT, .labels = {{"site", "north"}}, .label_count = 1};
    char existing[64] = "", *folder = fixture_folder();
    char *path = database_make(folder, format_1);
    (void)state;
    for (int opened = 0; opened < 2; opened++) {
        assert_int_equal(store_open(path, &store, &error), TALUS_OK);
        assert_int_equal(store_job_read(store, "j1", &job, &error), TALUS_OK);
        assert_string_equal(job.name, "first");
        assert_int_equal(job.priority, 7);
        assert_int_equal(job.revision, 3);
        assert_true(job.wall_used == 0.25);
        assert_string_equal(job.scene_hash, "h");
        assert_string_equal(job.owner, "");
        assert_null(job.study);
        assert_int_equal(store_key_find(store, &key, &result, existing, &error), TALUS_OK);
        assert_int_equal(result, STORE_REPLAYED);
        assert_string_equal(existing, "j1");
        job_release(&job);
        int count = 0;
        assert_int_equal(store_job_list(store, &labelled, job_count, &count, &error), TALUS_OK);
        assert_int_equal(count, 1);
        store_close(store);
    }
    free(path);
    fixture_folder_remove(folder);
}

static void test_newer_format_is_refused(void **state)
{
    struct talus_error error = {0};
    struct store *store = NULL;
    char *folder = fixture_folder();
    char *path = database_make(folder, "PRAGMA user_version = 1000;");
    (void)state;
    assert_int_equal(store_open(path, &store, &error), TALUS_IO);
    assert_string_equal(error.code, "version");
    assert_null(store);
    free(path);
    fixture_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_format_1_is_migrated),
        cmocka_unit_test(test_newer_format_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

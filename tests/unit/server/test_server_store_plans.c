/* SPDX-License-Identifier: Apache-2.0 */
/* A page of a list costs what is on it: SQLite's own counters of the statements that lists used say
 * that nothing was sorted and no more was walked over than the page holds. */
#include "server_fixture.h"

#include "folder.h"
#include "store_internal.h"

#include <stdlib.h>

enum { JOB_COUNT = 60, PAGE = 5 };

static void job_add(struct store *store, int number)
{
    struct talus_error error = {0};
    enum store_insert result;
    char id[32], labels[64], name[32], existing[64];
    (void)snprintf(id, sizeof id, "j%03d", number);
    (void)snprintf(labels, sizeof labels, "{\"even\":\"%d\",\"n\":\"%d\"}", number % 2 == 0,
                   number);
    struct job job = fixture_job(id);
    (void)snprintf(name, sizeof name, "Test %d", number);
    assert_int_equal(job_text_set(&job.labels, labels, &error), TALUS_OK);
    assert_int_equal(job_text_set(&job.name, name, &error), TALUS_OK);
    job.state = number % 3 == 0 ? JOB_FAILED : JOB_SUCCEEDED;
    assert_int_equal(store_job_insert(store, &job, NULL, NULL, &result, existing, &error),
                     TALUS_OK);
    job_release(&job);
}

static bool job_count(const struct job *job, void *context)
{
    (void)job;
    ++*(int *)context;
    return true;
}

/* Lists a page and returns the number of jobs on it. */
static int list_cheaply(struct store *store, struct store_filter filter)
{
    struct talus_error error = {0};
    int count = 0;
    filter.limit = PAGE;
    assert_int_equal(store_job_list(store, &filter, job_count, &count, &error), TALUS_OK);
    for (sqlite3_stmt *statement = sqlite3_next_stmt(store->reader, NULL); statement != NULL;
         statement = sqlite3_next_stmt(store->reader, statement)) {
        assert_int_equal(sqlite3_stmt_status(statement, SQLITE_STMTSTATUS_SORT, 1), 0);
        assert_int_equal(sqlite3_stmt_status(statement, SQLITE_STMTSTATUS_AUTOINDEX, 1), 0);
        assert_in_range(sqlite3_stmt_status(statement, SQLITE_STMTSTATUS_FULLSCAN_STEP, 1), 0,
                        PAGE);
    }
    return count;
}

static enum talus_status relabel(struct job *job, void *context, struct talus_error *error)
{
    return job_text_set(&job->labels, context, error);
}

static void test_lists_walk_over_indices(void **state)
{
    struct talus_error error = {0};
    struct store *store = NULL;
    char *folder = fixture_folder(), *path = folder_join(folder, "store");
    const struct store_filter all = {.state = JOB_STATE_COUNT};
    (void)state;
    assert_int_equal(store_open(path, &store, &error), TALUS_OK);
    for (int number = 0; number < JOB_COUNT; number++)
        job_add(store, number);
    struct store_filter filter = all;
    assert_int_equal(list_cheaply(store, filter), PAGE);
    filter.before = "j030";
    assert_int_equal(list_cheaply(store, filter), PAGE);
    filter = (struct store_filter){.state = JOB_FAILED, .before = "j030"};
    assert_int_equal(list_cheaply(store, filter), PAGE);
    filter = (struct store_filter){.state = JOB_QUEUED, .by_queue = true};
    assert_int_equal(list_cheaply(store, filter), 0);
    filter = all;
    filter.text = "test";
    assert_int_equal(list_cheaply(store, filter), PAGE);
    filter.before = "j030";
    assert_int_equal(list_cheaply(store, filter), PAGE);
    filter.text = "ST 7";
    assert_int_equal(list_cheaply(store, filter), 1);
    filter.text = "t 4";
    assert_int_equal(list_cheaply(store, filter), 1);
    filter.text = "te";
    assert_int_equal(list_cheaply(store, filter), PAGE);
    filter = all;
    filter.labels[0] = (struct store_label){"even", "1"};
    filter.label_count = 1;
    assert_int_equal(list_cheaply(store, filter), PAGE);
    filter.before = "j030";
    filter.state = JOB_FAILED;
    assert_int_equal(list_cheaply(store, filter), PAGE);
    filter = all;
    filter.labels[0] = (struct store_label){"n", "7"};
    filter.label_count = 1;
    assert_int_equal(list_cheaply(store, filter), 1);
    /* What a label was does not count any more. */
    assert_int_equal(store_job_change(store, "j007", relabel, "{\"n\":\"8\"}", NULL, &error),
                     TALUS_OK);
    assert_int_equal(list_cheaply(store, filter), 0);
    filter.labels[0].value = "8";
    assert_int_equal(list_cheaply(store, filter), 2);
    assert_int_equal(store_job_remove(store, "j007", &error), TALUS_OK);
    assert_int_equal(list_cheaply(store, filter), 1);
    store_close(store);
    free(path);
    fixture_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lists_walk_over_indices)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* A daemon that starts is told of what has changed since the mark, of what runs, and of what is
 * being removed; of nothing else. */
#include "server_fixture.h"

#include "store_recovery.h"

#include <stdio.h>
#include <string.h>

static void job_add(struct store *store, const char *id)
{
    struct talus_error error = {0};
    enum store_insert result;
    char existing[64];
    struct job job = fixture_job(id);
    assert_int_equal(store_job_insert(store, &job, NULL, NULL, &result, existing, &error),
                     TALUS_OK);
    job_release(&job);
}

/* To the next state, `context`. */
static enum talus_status state_change(struct job *job, void *context, struct talus_error *error)
{
    (void)error;
    job->state = *(const int64_t *)context;
    job->transition_count++;
    return TALUS_OK;
}

static enum talus_status deleting_set(struct job *job, void *context, struct talus_error *error)
{
    (void)context;
    (void)error;
    job->deleting = 1;
    return TALUS_OK;
}

static void job_move(struct store *store, const char *id, int64_t job_state)
{
    struct talus_error error = {0};
    assert_int_equal(store_job_change(store, id, state_change, &job_state, NULL, &error), TALUS_OK);
}

struct told {
    char text[256];
};

static void tell(const char *id, int64_t number, void *context)
{
    struct told *told = context;
    const size_t length = strlen(told->text);
    (void)snprintf(told->text + length, sizeof told->text - length, "%s:%d ", id, (int)number);
}

typedef enum talus_status ask(struct store *store, store_recovery_visit *visit, void *context,
                              struct talus_error *error);

static void check_told(struct store *store, ask *question, const char *expected)
{
    struct talus_error error = {0};
    struct told told = {""};
    assert_int_equal(question(store, tell, &told, &error), TALUS_OK);
    assert_string_equal(told.text, expected);
}

static void test_what_a_start_is_told(void **state)
{
    struct talus_error error = {0};
    struct store *store = ((struct store_fixture *)*state)->store;
    /* Nothing to mark is fine. */
    assert_int_equal(store_recovery_mark(store, &error), TALUS_OK);
    for (const char *id = "a\0b\0c\0d\0"; *id != '\0'; id += 2)
        job_add(store, id);
    job_move(store, "b", JOB_RUNNING);
    job_move(store, "c", JOB_RUNNING);
    job_move(store, "c", JOB_SUCCEEDED);
    check_told(store, store_recovery_untold, "a:1 c:3 d:1 ");
    check_told(store, store_recovery_removals, "");
    assert_int_equal(store_recovery_mark(store, &error), TALUS_OK);
    check_told(store, store_recovery_untold, "");
    job_move(store, "b", JOB_FAILED);
    job_move(store, "a", JOB_RUNNING);
    assert_int_equal(store_job_change(store, "d", deleting_set, NULL, NULL, &error), TALUS_OK);
    check_told(store, store_recovery_untold, "b:3 ");
    check_told(store, store_recovery_removals, "d:0 ");
    check_told(store, store_recovery_jobs, "d:0 a:1 c:2 b:3 ");
    _Static_assert(JOB_QUEUED == 0 && JOB_RUNNING == 1 && JOB_SUCCEEDED == 2 && JOB_FAILED == 3,
                   "these numbers");
    assert_int_equal(store_recovery_mark(store, &error), TALUS_OK);
    assert_int_equal(store_recovery_mark(store, &error), TALUS_OK);
    check_told(store, store_recovery_untold, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {STORE_TEST(test_what_a_start_is_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

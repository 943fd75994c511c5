/* SPDX-License-Identifier: Apache-2.0 */
/* The only ways in which a job's state changes. */
#include "server_fixture.h"

#include <string.h>

static const char boot[] = "boot";

static struct job_outcome outcome(enum job_end end, const char *reason)
{
    return (struct job_outcome){
        .end = end, .reason = reason, .detail = "why", .exit_code = -1, .signal_number = -1};
}

static void begin(struct job *job)
{
    struct talus_error error = {0};
    assert_int_equal(job_begin(job, boot, &error), TALUS_OK);
    assert_int_equal(job->state, JOB_RUNNING);
}

static void finish(struct job *job, enum job_end end, const char *reason, enum job_state expected)
{
    struct talus_error error = {0};
    struct job_outcome result = outcome(end, reason);
    assert_int_equal(job_finish(job, &result, &error), TALUS_OK);
    assert_int_equal(job->state, expected);
    assert_int_equal(job->finished_at != NULL, job_state_final(expected));
}

static void test_success(void **state)
{
    (void)state;
    struct job job = fixture_job("a");
    assert_int_equal(job.transition_count, 1);
    begin(&job);
    finish(&job, JOB_END_SUCCEEDED, NULL, JOB_SUCCEEDED);
    assert_int_equal(job.transition_count, 3);
    assert_int_equal(job.attempt, 1);
    assert_null(job.reason);
    assert_non_null(strstr(job.attempts, "\"outcome\":\"succeeded\""));
    job_release(&job);
}

static void test_crashes_are_retried(void **state)
{
    (void)state;
    struct job job = fixture_job("a");
    for (int attempt = 1; attempt <= 2; attempt++) {
        begin(&job);
        finish(&job, JOB_END_CRASHED, "crashed", JOB_QUEUED);
    }
    begin(&job);
    finish(&job, JOB_END_CRASHED, "crashed", JOB_FAILED);
    assert_string_equal(job.reason, "crashed");
    assert_int_equal(job.attempt, 3);
    job_release(&job);
}

static void test_losses_do_not_count(void **state)
{
    (void)state;
    struct job job = fixture_job("a");
    for (int attempt = 1; attempt <= 9; attempt++) {
        begin(&job);
        finish(&job, JOB_END_LOST, "lost", JOB_QUEUED);
    }
    assert_int_equal(job.crash_count, 0);
    job_release(&job);
}

static void test_no_other_reason_is_retried(void **state)
{
    (void)state;
    struct job job = fixture_job("a");
    begin(&job);
    finish(&job, JOB_END_FAILED, "unstable", JOB_FAILED);
    job_release(&job);
}

static void test_cancel(void **state)
{
    struct talus_error error = {0};
    (void)state;
    struct job queued = fixture_job("a"), running = fixture_job("b"), done = fixture_job("c");
    assert_int_equal(job_cancel(&queued, &error), TALUS_OK);
    assert_int_equal(queued.state, JOB_CANCELLED);
    assert_int_equal(job_cancel(&queued, &error), TALUS_OK);
    begin(&running);
    assert_int_equal(job_cancel(&running, &error), TALUS_OK);
    assert_int_equal(running.state, JOB_RUNNING);
    assert_int_equal(running.cancel_requested, 1);
    finish(&running, JOB_END_CRASHED, "crashed", JOB_CANCELLED);
    begin(&done);
    assert_int_equal(job_cancel(&done, &error), TALUS_OK);
    finish(&done, JOB_END_SUCCEEDED, NULL, JOB_SUCCEEDED);
    assert_int_equal(job_cancel(&done, &error), TALUS_LIMIT);
    assert_string_equal(error.code, "state");
    job_release(&queued);
    job_release(&running);
    job_release(&done);
}

static void test_resume(void **state)
{
    struct talus_error error = {0};
    (void)state;
    struct job job = fixture_job("a");
    assert_int_equal(job_resume(&job, &error), TALUS_LIMIT);
    assert_int_equal(job_cancel(&job, &error), TALUS_OK);
    assert_int_equal(job_resume(&job, &error), TALUS_OK);
    assert_int_equal(job.state, JOB_QUEUED);
    assert_null(job.finished_at);
    begin(&job);
    assert_int_equal(job_resume(&job, &error), TALUS_LIMIT);
    finish(&job, JOB_END_FAILED, "time_limit", JOB_FAILED);
    assert_int_equal(job_resume(&job, &error), TALUS_OK);
    assert_null(job.reason);
    begin(&job);
    assert_int_equal(job.attempt, 2);
    finish(&job, JOB_END_SUCCEEDED, NULL, JOB_SUCCEEDED);
    assert_int_equal(job_resume(&job, &error), TALUS_LIMIT);
    job_release(&job);
}

static void test_delete(void **state)
{
    struct talus_error error = {0};
    (void)state;
    struct job job = fixture_job("a");
    assert_int_equal(job_mark_deleted(&job, &error), TALUS_LIMIT);
    begin(&job);
    assert_int_equal(job_mark_deleted(&job, &error), TALUS_LIMIT);
    finish(&job, JOB_END_CANCELLED, NULL, JOB_CANCELLED);
    assert_int_equal(job_mark_deleted(&job, &error), TALUS_OK);
    assert_int_equal(job_resume(&job, &error), TALUS_LIMIT);
    job_release(&job);
}

static void test_begin_and_finish_only_once(void **state)
{
    struct talus_error error = {0};
    struct job_outcome success = outcome(JOB_END_SUCCEEDED, NULL);
    (void)state;
    struct job job = fixture_job("a");
    assert_int_equal(job_finish(&job, &success, &error), TALUS_LIMIT);
    begin(&job);
    assert_int_equal(job_begin(&job, boot, &error), TALUS_LIMIT);
    finish(&job, JOB_END_SUCCEEDED, NULL, JOB_SUCCEEDED);
    assert_int_equal(job_finish(&job, &success, &error), TALUS_LIMIT);
    job_release(&job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_success),
        cmocka_unit_test(test_crashes_are_retried),
        cmocka_unit_test(test_losses_do_not_count),
        cmocka_unit_test(test_no_other_reason_is_retried),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_resume),
        cmocka_unit_test(test_delete),
        cmocka_unit_test(test_begin_and_finish_only_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

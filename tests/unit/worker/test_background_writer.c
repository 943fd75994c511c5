/* SPDX-License-Identifier: Apache-2.0 */
/* The thread that writes files: order, bounds, errors and the end. */
#include "worker/background_writer.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { TASK_COUNT = 40 };

/* What the tasks of a test share. */
struct record {
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    bool gate_open;
    int order[TASK_COUNT], done, released, most_captured, captured;
    bool in_caller[TASK_COUNT];
    pthread_t caller;
};

struct numbered {
    struct record *record;
    int number;
    bool fails;
};

static enum talus_status perform(void *context, struct talus_error *error)
{
    const struct numbered *task = context;
    struct record *record = task->record;
    (void)pthread_mutex_lock(&record->mutex);
    while (!record->gate_open)
        (void)pthread_cond_wait(&record->changed, &record->mutex);
    record->in_caller[record->done] = pthread_equal(pthread_self(), record->caller) != 0;
    record->order[record->done++] = task->number;
    (void)pthread_mutex_unlock(&record->mutex);
    if (task->fails)
        return talus_error_set(error, TALUS_LIMIT, "disk_limit", "", "task %d", task->number);
    return TALUS_OK;
}

static void release(void *context)
{
    const struct numbered *task = context;
    (void)pthread_mutex_lock(&task->record->mutex);
    task->record->released++;
    task->record->captured--;
    (void)pthread_mutex_unlock(&task->record->mutex);
}

static void record_init(struct record *record, bool gate_open)
{
    memset(record, 0, sizeof *record);
    assert_int_equal(pthread_mutex_init(&record->mutex, NULL), 0);
    assert_int_equal(pthread_cond_init(&record->changed, NULL), 0);
    record->gate_open = gate_open;
    record->caller = pthread_self();
}

static void record_end(struct record *record)
{
    (void)pthread_cond_destroy(&record->changed);
    (void)pthread_mutex_destroy(&record->mutex);
}

static enum talus_status give(struct background_writer *writer, struct numbered *numbered,
                              struct talus_error *error)
{
    struct record *record = numbered->record;
    const struct writer_task task = {perform, release, numbered};
    (void)pthread_mutex_lock(&record->mutex);
    record->captured++;
    if (record->captured > record->most_captured)
        record->most_captured = record->captured;
    (void)pthread_mutex_unlock(&record->mutex);
    return writer_give(writer, &task, error);
}

static void tasks_are_done_in_order_and_all_of_them(void **state)
{
    struct record record;
    struct numbered tasks[TASK_COUNT];
    struct talus_error error = {.status = TALUS_OK};
    struct background_writer *writer = writer_create();
    (void)state;
    assert_non_null(writer);
    record_init(&record, true);
    for (int index = 0; index < TASK_COUNT; index++) {
        tasks[index] = (struct numbered){&record, index, false};
        assert_int_equal(give(writer, &tasks[index], &error), TALUS_OK);
    }
    assert_int_equal(writer_finish(writer, &error), TALUS_OK);
    assert_int_equal(record.done, TASK_COUNT);
    assert_int_equal(record.released, TASK_COUNT);
    for (int index = 0; index < TASK_COUNT; index++) {
        assert_int_equal(record.order[index], index);
        assert_false(record.in_caller[index]);
    }
    /* One is given while WRITER_QUEUE wait and one is under way. */
    assert_true(record.most_captured <= WRITER_QUEUE + 2);
    writer_destroy(writer);
    record_end(&record);
}

static void *open_gate(void *context)
{
    struct record *record = context;
    (void)pthread_mutex_lock(&record->mutex);
    record->gate_open = true;
    (void)pthread_cond_broadcast(&record->changed);
    (void)pthread_mutex_unlock(&record->mutex);
    return NULL;
}

static void giving_does_not_wait_while_there_is_room(void **state)
{
    struct record record;
    struct numbered tasks[WRITER_QUEUE + 1];
    struct talus_error error = {.status = TALUS_OK};
    struct background_writer *writer = writer_create();
    pthread_t other;
    (void)state;
    assert_non_null(writer);
    record_init(&record, false);
    /* With the gate shut nothing is ever done: this returns only if it does not wait. */
    for (int index = 0; index < WRITER_QUEUE; index++) {
        tasks[index] = (struct numbered){&record, index, false};
        assert_int_equal(give(writer, &tasks[index], &error), TALUS_OK);
    }
    assert_int_equal(record.done, 0);
    assert_int_equal(pthread_create(&other, NULL, open_gate, &record), 0);
    assert_int_equal(writer_drain(writer, &error), TALUS_OK);
    assert_int_equal(pthread_join(other, NULL), 0);
    assert_int_equal(record.done, WRITER_QUEUE);
    writer_destroy(writer);
    record_end(&record);
}

static void the_first_failure_stays_and_drops_the_rest(void **state)
{
    struct record record;
    struct numbered tasks[WRITER_QUEUE + 2];
    struct talus_error error = {.status = TALUS_OK};
    struct background_writer *writer = writer_create();
    (void)state;
    assert_non_null(writer);
    record_init(&record, false);
    for (int index = 0; index < WRITER_QUEUE; index++) {
        tasks[index] = (struct numbered){&record, index, index == 0};
        assert_int_equal(give(writer, &tasks[index], &error), TALUS_OK);
    }
    assert_int_equal(writer_check(writer, &error), TALUS_OK);
    (void)open_gate(&record);
    assert_int_equal(writer_drain(writer, &error), TALUS_LIMIT);
    assert_string_equal(error.code, "disk_limit");
    assert_string_equal(error.text, "task 0");
    assert_int_equal(record.done, 1);
    assert_int_equal(record.released, WRITER_QUEUE);
    error = (struct talus_error){.status = TALUS_OK};
    tasks[WRITER_QUEUE] = (struct numbered){&record, WRITER_QUEUE, false};
    assert_int_equal(give(writer, &tasks[WRITER_QUEUE], &error), TALUS_LIMIT);
    error = (struct talus_error){.status = TALUS_OK};
    assert_int_equal(writer_finish(writer, &error), TALUS_LIMIT);
    assert_string_equal(error.text, "task 0");
    assert_int_equal(record.done, 1);
    assert_int_equal(record.released, WRITER_QUEUE + 1);
    writer_destroy(writer);
    record_end(&record);
}

static void after_the_end_tasks_are_done_at_once(void **state)
{
    struct record record;
    struct numbered good, bad;
    struct talus_error error = {.status = TALUS_OK};
    struct background_writer *writer = writer_create();
    (void)state;
    assert_non_null(writer);
    record_init(&record, true);
    good = (struct numbered){&record, 0, false};
    bad = (struct numbered){&record, 1, true};
    assert_int_equal(writer_finish(writer, &error), TALUS_OK);
    assert_int_equal(give(writer, &good, &error), TALUS_OK);
    assert_int_equal(record.done, 1);
    assert_true(record.in_caller[0]);
    assert_int_equal(give(writer, &bad, &error), TALUS_LIMIT);
    assert_int_equal(record.released, 2);
    writer_destroy(writer);
    record_end(&record);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tasks_are_done_in_order_and_all_of_them),
        cmocka_unit_test(giving_does_not_wait_while_there_is_room),
        cmocka_unit_test(the_first_failure_stays_and_drops_the_rest),
        cmocka_unit_test(after_the_end_tasks_are_done_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

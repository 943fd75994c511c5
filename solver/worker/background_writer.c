/* SPDX-License-Identifier: Apache-2.0 */
#include "worker/background_writer.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

struct background_writer {
    pthread_mutex_t mutex; /* guards all that follows but `thread` and `started` */
    pthread_cond_t changed;
    struct writer_task queue[WRITER_QUEUE];
    size_t first, count; /* of the tasks that wait */
    bool busy, ending;
    struct talus_error error; /* of the first task that failed */
    pthread_t thread;
    bool started; /* the thread lives */
    bool inline_only;
};

struct background_writer *writer_create(void)
{
    struct background_writer *writer = calloc(1, sizeof *writer);
    if (writer == NULL)
        return NULL;
    if (pthread_mutex_init(&writer->mutex, NULL) != 0) {
        free(writer);
        return NULL;
    }
    if (pthread_cond_init(&writer->changed, NULL) != 0) {
        (void)pthread_mutex_destroy(&writer->mutex);
        free(writer);
        return NULL;
    }
    writer->error.status = TALUS_OK;
    return writer;
}

static enum talus_status copy_error(const struct background_writer *writer,
                                    struct talus_error *error)
{
    if (writer->error.status != TALUS_OK && error->status == TALUS_OK)
        *error = writer->error;
    return writer->error.status;
}

/* Does or drops one task; called without the mutex. */
static struct talus_error do_task(const struct writer_task *task, bool drop)
{
    struct talus_error error = {.status = TALUS_OK};
    if (!drop)
        error.status = task->perform(task->context, &error);
    task->release(task->context);
    return error;
}

static void *work(void *context)
{
    struct background_writer *writer = context;
    (void)pthread_mutex_lock(&writer->mutex);
    for (;;) {
        while (writer->count == 0 && !writer->ending)
            (void)pthread_cond_wait(&writer->changed, &writer->mutex);
        if (writer->count == 0)
            break;
        const struct writer_task task = writer->queue[writer->first];
        const bool drop = writer->error.status != TALUS_OK;
        writer->first = (writer->first + 1) % WRITER_QUEUE;
        writer->count--;
        writer->busy = true;
        (void)pthread_cond_broadcast(&writer->changed);
        (void)pthread_mutex_unlock(&writer->mutex);
        const struct talus_error error = do_task(&task, drop);
        (void)pthread_mutex_lock(&writer->mutex);
        if (error.status != TALUS_OK)
            writer->error = error;
        writer->busy = false;
        (void)pthread_cond_broadcast(&writer->changed);
    }
    (void)pthread_mutex_unlock(&writer->mutex);
    return NULL;
}

static bool has_thread(struct background_writer *writer)
{
    if (!writer->started && !writer->inline_only) {
        writer->started = pthread_create(&writer->thread, NULL, work, writer) == 0;
        writer->inline_only = !writer->started;
    }
    return writer->started;
}

enum talus_status writer_give(struct background_writer *writer, const struct writer_task *task,
                              struct talus_error *error)
{
    if (!has_thread(writer)) {
        const struct talus_error failure = do_task(task, writer->error.status != TALUS_OK);
        if (failure.status != TALUS_OK)
            writer->error = failure;
        return copy_error(writer, error);
    }
    (void)pthread_mutex_lock(&writer->mutex);
    while (writer->count == WRITER_QUEUE)
        (void)pthread_cond_wait(&writer->changed, &writer->mutex);
    writer->queue[(writer->first + writer->count++) % WRITER_QUEUE] = *task;
    (void)pthread_cond_broadcast(&writer->changed);
    const enum talus_status status = copy_error(writer, error);
    (void)pthread_mutex_unlock(&writer->mutex);
    return status;
}

enum talus_status writer_check(struct background_writer *writer, struct talus_error *error)
{
    (void)pthread_mutex_lock(&writer->mutex);
    const enum talus_status status = copy_error(writer, error);
    (void)pthread_mutex_unlock(&writer->mutex);
    return status;
}

enum talus_status writer_drain(struct background_writer *writer, struct talus_error *error)
{
    (void)pthread_mutex_lock(&writer->mutex);
    while (writer->count > 0 || writer->busy)
        (void)pthread_cond_wait(&writer->changed, &writer->mutex);
    const enum talus_status status = copy_error(writer, error);
    (void)pthread_mutex_unlock(&writer->mutex);
    return status;
}

/* The thread does what waits before it ends. */
static void end_thread(struct background_writer *writer)
{
    if (writer->started) {
        (void)pthread_mutex_lock(&writer->mutex);
        writer->ending = true;
        (void)pthread_cond_broadcast(&writer->changed);
        (void)pthread_mutex_unlock(&writer->mutex);
        (void)pthread_join(writer->thread, NULL);
    }
    writer->started = false;
    writer->inline_only = true;
}

enum talus_status writer_finish(struct background_writer *writer, struct talus_error *error)
{
    end_thread(writer);
    return copy_error(writer, error);
}

void writer_destroy(struct background_writer *writer)
{
    if (writer == NULL)
        return;
    end_thread(writer);
    (void)pthread_cond_destroy(&writer->changed);
    (void)pthread_mutex_destroy(&writer->mutex);
    free(writer);
}

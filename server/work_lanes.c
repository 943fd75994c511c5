/* SPDX-License-Identifier: Apache-2.0 */
#include "work_lanes.h"

#include "access.h"
#include "audit.h"
#include "helper.h"
#include "service.h"

#include <pthread.h>
#include <stdlib.h>

enum { QUICK_THREADS = 4, THREADS_MAX = 32, QUEUE_MAX = 2048 };

struct queue {
    struct request *first, *last;
    size_t length;
};

struct lane_thread {
    struct lanes *lanes;
    enum lane lane;
    struct helper helper; /* of the HELPER lane */
    pthread_t thread;
};

struct lanes {
    pthread_mutex_t mutex;
    pthread_cond_t queued[2];
    struct queue queues[2]; /* QUICK, HELPER */
    struct lane_thread threads[THREADS_MAX];
    size_t thread_count, busy_count;
    bool stopping;
};

static size_t queue_index(enum lane lane)
{
    return lane == LANE_HELPER ? 1 : 0;
}

/* Handles a request and lets its reply go out, unless it waits for something. */
static void request_answer(struct request *request)
{
    struct MHD_Connection *connection = request->connection;
    bool change = access_is_change(request);
    if (access_owner_check(request) && request->route->handle(request) == HANDLED_PARKED)
        return; /* and may have been answered by now */
    if (change) {
        audit_request(request->service->audit, request);
        request->audited = true;
    }
    MHD_resume_connection(connection);
}

static void *lane_main(void *argument)
{
    struct lane_thread *own = argument;
    struct lanes *lanes = own->lanes;
    struct queue *queue = &lanes->queues[queue_index(own->lane)];
    (void)pthread_mutex_lock(&lanes->mutex);
    for (;;) {
        while (queue->first == NULL && !lanes->stopping)
            (void)pthread_cond_wait(&lanes->queued[queue_index(own->lane)], &lanes->mutex);
        struct request *request = queue->first;
        if (request == NULL)
            break;
        queue->first = request->next;
        if (queue->first == NULL)
            queue->last = NULL;
        queue->length--;
        (void)pthread_mutex_unlock(&lanes->mutex);
        request->next = NULL;
        request->helper = own->lane == LANE_HELPER ? &own->helper : NULL;
        request_answer(request);
        (void)pthread_mutex_lock(&lanes->mutex);
        lanes->busy_count--;
    }
    (void)pthread_mutex_unlock(&lanes->mutex);
    helper_stop(&own->helper);
    return NULL;
}

static bool thread_start(struct lanes *lanes, enum lane lane, const struct config *config)
{
    struct lane_thread *own = &lanes->threads[lanes->thread_count];
    own->lanes = lanes;
    own->lane = lane;
    helper_init(&own->helper, config);
    if (pthread_create(&own->thread, NULL, lane_main, own) != 0)
        return false;
    lanes->thread_count++;
    return true;
}

enum talus_status lanes_create(struct lanes **result, const struct config *config,
                               struct talus_error *error)
{
    struct lanes *lanes = calloc(1, sizeof *lanes);
    *result = lanes;
    if (lanes == NULL)
        return talus_error_memory(error);
    (void)pthread_mutex_init(&lanes->mutex, NULL);
    (void)pthread_cond_init(&lanes->queued[0], NULL);
    (void)pthread_cond_init(&lanes->queued[1], NULL);
    bool good = true;
    for (int index = 0; index < QUICK_THREADS && good; index++)
        good = thread_start(lanes, LANE_QUICK, config);
    for (int index = 0; index < (int)config->helpers && good; index++)
        good = thread_start(lanes, LANE_HELPER, config);
    if (good)
        return TALUS_OK;
    lanes_destroy(lanes);
    *result = NULL;
    return talus_error_set(error, TALUS_INTERNAL, "thread", "", "cannot start a thread");
}

void lanes_destroy(struct lanes *lanes)
{
    if (lanes == NULL)
        return;
    (void)pthread_mutex_lock(&lanes->mutex);
    lanes->stopping = true;
    (void)pthread_cond_broadcast(&lanes->queued[0]);
    (void)pthread_cond_broadcast(&lanes->queued[1]);
    (void)pthread_mutex_unlock(&lanes->mutex);
    for (size_t index = 0; index < lanes->thread_count; index++)
        (void)pthread_join(lanes->threads[index].thread, NULL);
    (void)pthread_cond_destroy(&lanes->queued[0]);
    (void)pthread_cond_destroy(&lanes->queued[1]);
    (void)pthread_mutex_destroy(&lanes->mutex);
    free(lanes);
}

bool lanes_hand_in(struct lanes *lanes, struct request *request)
{
    size_t index = queue_index(request->route->lane);
    struct queue *queue = &lanes->queues[index];
    (void)pthread_mutex_lock(&lanes->mutex);
    bool taken = queue->length < QUEUE_MAX && !lanes->stopping;
    if (taken) {
        request->next = NULL;
        if (queue->last == NULL)
            queue->first = request;
        else
            queue->last->next = request;
        queue->last = request;
        queue->length++;
        lanes->busy_count++;
        (void)pthread_cond_signal(&lanes->queued[index]);
    }
    (void)pthread_mutex_unlock(&lanes->mutex);
    return taken;
}

size_t lanes_busy_count(struct lanes *lanes)
{
    (void)pthread_mutex_lock(&lanes->mutex);
    size_t count = lanes->busy_count;
    (void)pthread_mutex_unlock(&lanes->mutex);
    return count;
}

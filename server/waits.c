/* SPDX-License-Identifier: Apache-2.0 */
#include "waits.h"

#include "moment.h"
#include "service.h"
#include "work_lanes.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct waits {
    pthread_mutex_t mutex;
    struct request *first;
    uint64_t change_count;
    bool ended;
};

enum talus_status waits_create(struct waits **result, struct talus_error *error)
{
    struct waits *waits = calloc(1, sizeof *waits);
    *result = waits;
    if (waits == NULL)
        return talus_error_memory(error);
    (void)pthread_mutex_init(&waits->mutex, NULL);
    return TALUS_OK;
}

void waits_destroy(struct waits *waits)
{
    if (waits == NULL)
        return;
    (void)pthread_mutex_destroy(&waits->mutex);
    free(waits);
}

uint64_t waits_mark(struct waits *waits)
{
    (void)pthread_mutex_lock(&waits->mutex);
    uint64_t mark = waits->change_count;
    (void)pthread_mutex_unlock(&waits->mutex);
    return mark;
}

bool waits_park(struct waits *waits, struct request *request, uint64_t mark)
{
    (void)pthread_mutex_lock(&waits->mutex);
    bool parked = !waits->ended && mark == waits->change_count;
    request->expired = waits->ended;
    if (parked) {
        request->next = waits->first;
        waits->first = request;
    }
    (void)pthread_mutex_unlock(&waits->mutex);
    return parked;
}

/* Unlinks the requests of a job (NULL: any) or those whose deadline has passed. */
static struct request *waits_take(struct waits *waits, const char *id, double now)
{
    struct request *taken = NULL;
    struct request **link = &waits->first;
    (void)pthread_mutex_lock(&waits->mutex);
    waits->change_count += id != NULL;
    while (*link != NULL) {
        struct request *request = *link;
        bool over = now >= request->deadline;
        if (!over && (id == NULL || strcmp(id, request->segment) != 0)) {
            link = &request->next;
            continue;
        }
        request->expired = over;
        *link = request->next;
        request->next = taken;
        taken = request;
    }
    (void)pthread_mutex_unlock(&waits->mutex);
    return taken;
}

static void waits_hand_in(struct request *request)
{
    while (request != NULL) {
        struct request *next = request->next;
        struct MHD_Connection *connection = request->connection;
        if (!lanes_hand_in(request->service->lanes, request)) {
            reply_problem(&request->reply, MHD_HTTP_SERVICE_UNAVAILABLE, "busy", request->raw, NULL,
                          "too many requests wait");
            MHD_resume_connection(connection);
        }
        request = next;
    }
}

void waits_notify(struct waits *waits, const char *id)
{
    waits_hand_in(waits_take(waits, id, moment_monotonic()));
}

void waits_tick(struct waits *waits)
{
    waits_hand_in(waits_take(waits, NULL, moment_monotonic()));
}

void waits_end(struct waits *waits)
{
    (void)pthread_mutex_lock(&waits->mutex);
    waits->ended = true;
    for (struct request *request = waits->first; request != NULL; request = request->next)
        request->deadline = 0;
    (void)pthread_mutex_unlock(&waits->mutex);
    waits_hand_in(waits_take(waits, NULL, moment_monotonic()));
}

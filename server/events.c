/* SPDX-License-Identifier: Apache-2.0 */
#include "events.h"

#include "access.h"
#include "moment.h"
#include "service.h"
#include "waits.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { STREAM_BLOCK_BYTES = 8192 };
static const double tick_seconds = 0.1, idle_seconds = 0.25; /* with and without readers */
/* Looks that take less need no pause, which costs a wake-up itself. */
static const double short_look_seconds = 1e-3;
static const double comment_seconds = 15;

/* One reader. The events thread owns the source; `ready` and the flags belong to the mutex. */
struct subscription {
    struct events *events;
    struct MHD_Connection *connection;
    struct event_source source;
    struct token_proof proof;
    struct text ready; /* for the HTTP thread */
    size_t sent;       /* bytes of it that are gone */
    double last_sent;  /* when the reader last took something */
    bool behind;       /* there may be more to tell at once */
    bool suspended, ended, closed;
    bool revoked; /* the token is not in force any more */
    struct subscription *next;
};

struct events {
    struct service *service;
    pthread_mutex_t mutex;
    pthread_cond_t wake;
    pthread_t thread;
    struct subscription *first;
    struct feed *feed;
    bool woken, ending, stopping;
};

static ssize_t subscription_read(void *context, uint64_t position, char *buffer, size_t size)
{
    struct subscription *own = context;
    struct events *events = own->events;
    (void)position;
    (void)pthread_mutex_lock(&events->mutex);
    size_t left = own->ready.length - own->sent;
    ssize_t result = 0;
    if (left > 0) {
        size_t length = left < size ? left : size;
        memcpy(buffer, own->ready.data + own->sent, length);
        own->sent += length;
        own->last_sent = moment_monotonic();
        result = (ssize_t)length;
        if (own->sent == own->ready.length) {
            /* Thousands of idle readers must not each keep a buffer. */
            text_release(&own->ready);
            own->sent = 0;
            events->woken = events->woken || own->behind;
            if (own->behind)
                (void)pthread_cond_signal(&events->wake);
        }
    } else if (own->ended) {
        result = MHD_CONTENT_READER_END_OF_STREAM;
    } else {
        own->suspended = true;
        MHD_suspend_connection(own->connection);
    }
    (void)pthread_mutex_unlock(&events->mutex);
    return result;
}

static void subscription_free(void *context)
{
    struct subscription *own = context;
    (void)pthread_mutex_lock(&own->events->mutex);
    own->closed = true;
    own->events->woken = true;
    (void)pthread_cond_signal(&own->events->wake);
    (void)pthread_mutex_unlock(&own->events->mutex);
}

static void subscription_service(struct subscription *own, struct event_steps *steps, double now)
{
    struct events *events = own->events;
    struct text *out = event_source_out(&own->source);
    const struct config *config = events->service->config;
    (void)pthread_mutex_lock(&events->mutex);
    bool idle = own->ready.length == 0 && !own->ended && !own->closed;
    double silent = now - own->last_sent;
    bool stalled = own->ready.length > 0 && !own->closed && !own->ended;
    (void)pthread_mutex_unlock(&events->mutex);
    stalled = stalled && silent > config->gap_seconds &&
              (double)event_source_backlog(&own->source) > config->gap_bytes;
    if (idle)
        event_source_fill(&own->source, steps);
    if (stalled)
        event_source_skip(&own->source);
    if (idle && out->length == 0 && silent >= comment_seconds)
        text_add_string(out, ": still here\n\n");
    (void)pthread_mutex_lock(&events->mutex);
    /* What is left out for its length comes in pieces of more than this. */
    if (idle)
        own->behind = out->length >= STREAM_BLOCK_BYTES;
    if (out->length > 0)
        text_add(&own->ready, out->data, out->length);
    if (event_source_done(&own->source) || own->ready.failed || out->failed || events->ending ||
        own->revoked)
        own->ended = true;
    text_release(out);
    if (own->suspended && (own->ready.length > 0 || own->ended) && !own->closed) {
        own->suspended = false;
        if (idle)
            own->last_sent = now;
        MHD_resume_connection(own->connection);
    }
    (void)pthread_mutex_unlock(&events->mutex);
}

static void subscriptions_sweep(struct events *events)
{
    struct subscription **link = &events->first;
    while (*link != NULL) {
        struct subscription *own = *link;
        if (!own->closed) {
            link = &own->next;
            continue;
        }
        *link = own->next;
        event_source_close(&own->source);
        text_release(&own->ready);
        free(own);
    }
}

static void events_wait(struct events *events)
{
    struct timespec until;
    (void)clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += (long)((events->first == NULL ? idle_seconds : tick_seconds) * 1e9);
    if (until.tv_nsec >= 1000000000L) {
        until.tv_nsec -= 1000000000L;
        until.tv_sec++;
    }
    int waited = 0;
    while (!events->woken && !events->stopping && waited != ETIMEDOUT)
        waited = pthread_cond_timedwait(&events->wake, &events->mutex, &until);
    events->woken = false;
}

/* Every reader that has taken what there was asks for the next look at all readers. It waits as
 * long as the last one took, so that one look serves many of them. */
static void looks_pace(double seconds)
{
    if (seconds > short_look_seconds)
        (void)usleep((useconds_t)(1e6 * (seconds < tick_seconds ? seconds : tick_seconds)));
}

static void *events_main(void *argument)
{
    struct events *events = argument;
    (void)pthread_mutex_lock(&events->mutex);
    while (!events->stopping) {
        events_wait(events);
        subscriptions_sweep(events);
        struct subscription *first = events->first;
        bool of_all = false;
        for (const struct subscription *own = first; own != NULL; own = own->next)
            of_all = of_all || own->source.kind == SOURCE_ALL;
        (void)pthread_mutex_unlock(&events->mutex);
        /* Readers are only added at the head and only removed by this thread. */
        double now = moment_monotonic();
        struct event_steps steps = {0};
        if (of_all)
            feed_refresh(events->feed);
        for (struct subscription *own = first; own != NULL; own = own->next)
            subscription_service(own, &steps, now);
        event_steps_clear(&steps);
        waits_tick(events->service->waits);
        looks_pace(moment_monotonic() - now);
        (void)pthread_mutex_lock(&events->mutex);
    }
    subscriptions_sweep(events);
    (void)pthread_mutex_unlock(&events->mutex);
    return NULL;
}

enum talus_status events_create(struct events **result, struct service *service,
                                struct talus_error *error)
{
    struct events *events = calloc(1, sizeof *events);
    *result = events;
    if (events == NULL)
        return talus_error_memory(error);
    events->service = service;
    (void)pthread_mutex_init(&events->mutex, NULL);
    (void)pthread_cond_init(&events->wake, NULL);
    enum talus_status status = feed_create(&events->feed, service->store, error);
    if (status == TALUS_OK && pthread_create(&events->thread, NULL, events_main, events) != 0)
        status = talus_error_set(error, TALUS_INTERNAL, "thread", "", "cannot start a thread");
    if (status == TALUS_OK)
        return TALUS_OK;
    feed_destroy(events->feed);
    free(events);
    *result = NULL;
    return status;
}

void events_destroy(struct events *events)
{
    if (events == NULL)
        return;
    (void)pthread_mutex_lock(&events->mutex);
    events->stopping = true;
    (void)pthread_cond_signal(&events->wake);
    (void)pthread_mutex_unlock(&events->mutex);
    (void)pthread_join(events->thread, NULL);
    feed_destroy(events->feed);
    (void)pthread_cond_destroy(&events->wake);
    (void)pthread_mutex_destroy(&events->mutex);
    free(events);
}

struct feed *events_feed(struct events *events)
{
    return events->feed;
}

void events_subscribe(struct events *events, struct request *request,
                      const struct event_source *source)
{
    struct subscription *own = calloc(1, sizeof *own);
    struct MHD_Response *response =
        own == NULL ? NULL
                    : MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, STREAM_BLOCK_BYTES,
                                                        subscription_read, own, subscription_free);
    if (response == NULL) {
        free(own);
        struct event_source unused = *source;
        event_source_close(&unused);
        return;
    }
    own->events = events;
    own->connection = request->connection;
    own->source = *source;
    own->proof = request->proof;
    own->last_sent = moment_monotonic();
    own->behind = true;
    /* Also pushes the header fields out. */
    text_add_string(&own->ready, "retry: 1000\n\n");
    reply_stream(&request->reply, response);
    (void)pthread_mutex_lock(&events->mutex);
    own->ended = events->ending;
    own->revoked = !access_holds(events->service->access, &own->proof);
    own->next = events->first;
    events->first = own;
    events->woken = true;
    (void)pthread_cond_signal(&events->wake);
    (void)pthread_mutex_unlock(&events->mutex);
}

size_t events_reader_count(struct events *events)
{
    size_t count = 0;
    (void)pthread_mutex_lock(&events->mutex);
    for (const struct subscription *own = events->first; own != NULL; own = own->next)
        count += !own->closed;
    (void)pthread_mutex_unlock(&events->mutex);
    return count;
}

void events_wake(struct events *events)
{
    (void)pthread_mutex_lock(&events->mutex);
    events->woken = true;
    (void)pthread_cond_signal(&events->wake);
    (void)pthread_mutex_unlock(&events->mutex);
}

void events_access_recheck(struct events *events)
{
    (void)pthread_mutex_lock(&events->mutex);
    for (struct subscription *own = events->first; own != NULL; own = own->next)
        own->revoked = !access_holds(events->service->access, &own->proof);
    events->woken = true;
    (void)pthread_cond_signal(&events->wake);
    (void)pthread_mutex_unlock(&events->mutex);
}

void events_end(struct events *events)
{
    bool suspended = true;
    while (suspended) {
        (void)pthread_mutex_lock(&events->mutex);
        events->ending = true;
        events->woken = true;
        (void)pthread_cond_signal(&events->wake);
        suspended = false;
        for (struct subscription *own = events->first; own != NULL; own = own->next)
            suspended = suspended || !own->ended || own->suspended;
        (void)pthread_mutex_unlock(&events->mutex);
        if (suspended)
            (void)usleep(1000);
    }
}

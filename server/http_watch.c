/* SPDX-License-Identifier: Apache-2.0 */
#include "http_watch.h"

#include "moment.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>

struct connection_watch {
    struct http_watch *watch;
    int descriptor;
    double since; /* monotonic: when the current request could begin */
    bool receiving;
    struct connection_watch *previous, *next;
};

struct http_watch {
    double seconds;
    pthread_mutex_t mutex;
    pthread_cond_t wake;
    pthread_t thread;
    struct connection_watch *first;
    bool stopping;
};

static void late_shut_down(struct http_watch *watch)
{
    double now = moment_monotonic();
    for (struct connection_watch *connection = watch->first; connection != NULL;
         connection = connection->next) {
        if (connection->receiving && now - connection->since > watch->seconds)
            (void)shutdown(connection->descriptor, SHUT_RDWR);
    }
}

static void *watch_main(void *argument)
{
    struct http_watch *watch = argument;
    (void)pthread_mutex_lock(&watch->mutex);
    while (!watch->stopping) {
        struct timespec until;
        (void)clock_gettime(CLOCK_REALTIME, &until);
        until.tv_sec++;
        (void)pthread_cond_timedwait(&watch->wake, &watch->mutex, &until);
        late_shut_down(watch);
    }
    (void)pthread_mutex_unlock(&watch->mutex);
    return NULL;
}

enum talus_status http_watch_create(struct http_watch **result, double seconds,
                                    struct talus_error *error)
{
    struct http_watch *watch = calloc(1, sizeof *watch);
    *result = watch;
    if (watch == NULL)
        return talus_error_memory(error);
    watch->seconds = seconds;
    (void)pthread_mutex_init(&watch->mutex, NULL);
    (void)pthread_cond_init(&watch->wake, NULL);
    if (pthread_create(&watch->thread, NULL, watch_main, watch) == 0)
        return TALUS_OK;
    free(watch);
    *result = NULL;
    return talus_error_set(error, TALUS_INTERNAL, "thread", "", "cannot start a thread");
}

void http_watch_destroy(struct http_watch *watch)
{
    if (watch == NULL)
        return;
    (void)pthread_mutex_lock(&watch->mutex);
    watch->stopping = true;
    (void)pthread_cond_signal(&watch->wake);
    (void)pthread_mutex_unlock(&watch->mutex);
    (void)pthread_join(watch->thread, NULL);
    (void)pthread_cond_destroy(&watch->wake);
    (void)pthread_mutex_destroy(&watch->mutex);
    free(watch);
}

struct connection_watch *http_watch_open(struct http_watch *watch, int descriptor)
{
    struct connection_watch *connection = calloc(1, sizeof *connection);
    if (connection == NULL)
        return NULL;
    connection->watch = watch;
    connection->descriptor = descriptor;
    connection->since = moment_monotonic();
    connection->receiving = true;
    (void)pthread_mutex_lock(&watch->mutex);
    connection->next = watch->first;
    if (watch->first != NULL)
        watch->first->previous = connection;
    watch->first = connection;
    (void)pthread_mutex_unlock(&watch->mutex);
    return connection;
}

void http_watch_closed(struct connection_watch *connection)
{
    if (connection == NULL)
        return;
    struct http_watch *watch = connection->watch;
    (void)pthread_mutex_lock(&watch->mutex);
    if (connection->previous == NULL)
        watch->first = connection->next;
    else
        connection->previous->next = connection->next;
    if (connection->next != NULL)
        connection->next->previous = connection->previous;
    (void)pthread_mutex_unlock(&watch->mutex);
    free(connection);
}

static void receiving_set(struct connection_watch *connection, bool receiving)
{
    if (connection == NULL)
        return;
    (void)pthread_mutex_lock(&connection->watch->mutex);
    connection->receiving = receiving;
    connection->since = moment_monotonic();
    (void)pthread_mutex_unlock(&connection->watch->mutex);
}

void http_watch_arrived(struct connection_watch *connection)
{
    receiving_set(connection, false);
}

void http_watch_idle(struct connection_watch *connection)
{
    receiving_set(connection, true);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "loadgen_polls.h"

#include "loadgen_answer.h"
#include "loadgen_samples.h"
#include "loadgen_socket.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

enum { EVENTS_MAX = 256, READ_BYTES = 256 << 10 };
/* An answer that has not come so long after the end will not come. */
static const double patience = 30;

struct connection {
    int descriptor;
    bool busy, broken;
    double due;    /* when the request under way was due */
    size_t queued; /* requests that were due while it was busy (paced load) */
    double queued_due;
    struct answer answer;
};

struct polls {
    const struct polls_options *options;
    struct connection *connections;
    char **requests; /* one for each path */
    size_t next_path;
    int epoll;
    size_t open, busy, request_count, failure_count;
    uint64_t bytes;
    double end;
    bool measuring;
    struct samples latency;
    char buffer[READ_BYTES];
};

static void connection_fail(struct polls *polls, struct connection *connection)
{
    polls->failure_count++;
    polls->busy -= connection->busy;
    polls->open--;
    connection->busy = false;
    connection->broken = true;
    (void)close(connection->descriptor);
}

static void request_send(struct polls *polls, struct connection *connection, double due)
{
    const char *request = polls->requests[polls->next_path];
    polls->next_path = (polls->next_path + 1) % polls->options->path_count;
    connection->answer = (struct answer){.part = ANSWER_HEAD};
    connection->due = due;
    connection->busy = true;
    polls->busy++;
    size_t length = 0;
    while (request[length] != '\0')
        length++;
    if (!loadgen_send(connection->descriptor, request, length))
        connection_fail(polls, connection);
}

/* An answer is complete: counts it and asks again if that is due. */
static void answer_complete(struct polls *polls, struct connection *connection)
{
    double now = loadgen_now();
    connection->busy = false;
    polls->busy--;
    if (polls->measuring && connection->due < polls->end) {
        samples_add(&polls->latency, now - connection->due);
        polls->request_count++;
    }
    polls->failure_count += connection->answer.status != 200;
    if (!polls->measuring || now >= polls->end)
        return;
    if (polls->options->rate <= 0) {
        request_send(polls, connection, now);
    } else if (connection->queued > 0) {
        double period = (double)polls->options->active / polls->options->rate;
        connection->queued--;
        request_send(polls, connection, connection->queued_due);
        connection->queued_due += period;
    }
}

static void connection_read(struct polls *polls, struct connection *connection)
{
    ssize_t length = recv(connection->descriptor, polls->buffer, sizeof polls->buffer, 0);
    if (length <= 0 || !connection->busy) {
        connection_fail(polls, connection);
        return;
    }
    polls->bytes += (uint64_t)length;
    size_t used = answer_take(&connection->answer, polls->buffer, (size_t)length, NULL, NULL);
    if (connection->answer.broken || used < (size_t)length)
        connection_fail(polls, connection);
    else if (connection->answer.part == ANSWER_END)
        answer_complete(polls, connection);
}

/* Reads what has come; waits for something at most `milliseconds`. */
static void polls_wait(struct polls *polls, int milliseconds)
{
    struct epoll_event events[EVENTS_MAX];
    int count = epoll_wait(polls->epoll, events, EVENTS_MAX, milliseconds);
    for (int index = 0; index < count; index++) {
        struct connection *connection = events[index].data.ptr;
        if (!connection->broken)
            connection_read(polls, connection);
    }
}

/* Opens all connections and has each answered once, 100 at a time. */
static bool connections_open(struct polls *polls)
{
    enum { AT_ONCE = 100 };
    for (size_t index = 0; index < polls->options->connections; index++) {
        struct connection *connection = &polls->connections[index];
        struct epoll_event event = {.events = EPOLLIN, .data = {.ptr = connection}};
        connection->descriptor = loadgen_connect(polls->options->port);
        if (connection->descriptor < 0 ||
            epoll_ctl(polls->epoll, EPOLL_CTL_ADD, connection->descriptor, &event) != 0)
            return false;
        polls->open++;
        request_send(polls, connection, loadgen_now());
        bool last = index + 1 == polls->options->connections;
        double deadline = loadgen_now() + patience;
        while (polls->busy >= (last ? 1 : AT_ONCE) && loadgen_now() < deadline)
            polls_wait(polls, 100);
    }
    return polls->open == polls->options->connections && polls->busy == 0;
}

/* Sends what is due by now at an even pace; `*sent` requests were due before. */
static void paced_send(struct polls *polls, double begin, size_t *sent)
{
    const struct polls_options *options = polls->options;
    for (;; (*sent)++) {
        double due = begin + (double)*sent / options->rate;
        struct connection *connection = &polls->connections[*sent % options->active];
        if (due > loadgen_now() || due >= polls->end)
            return;
        if (connection->broken)
            continue;
        if (!connection->busy) {
            request_send(polls, connection, due);
        } else if (connection->queued++ == 0) {
            connection->queued_due = due;
        }
    }
}

static double measure(struct polls *polls)
{
    const struct polls_options *options = polls->options;
    double begin = loadgen_now();
    size_t sent = 0;
    polls->bytes = 0;
    polls->measuring = true;
    polls->end = begin + options->seconds;
    for (size_t index = 0; index < options->active && options->rate <= 0; index++)
        request_send(polls, &polls->connections[index], loadgen_now());
    while (loadgen_now() < polls->end && polls->open > 0) {
        if (options->rate > 0)
            paced_send(polls, begin, &sent);
        polls_wait(polls, 1);
    }
    while (polls->busy > 0 && loadgen_now() < polls->end + patience)
        polls_wait(polls, 100);
    double elapsed = loadgen_now() - begin;
    polls->failure_count += polls->busy;
    for (size_t index = 0; index < options->active; index++)
        polls->failure_count += polls->connections[index].queued;
    return elapsed;
}

static void report(struct polls *polls, double elapsed)
{
    const struct polls_options *options = polls->options;
    (void)printf("{\"connections\":%zu,\"active\":%zu,\"open_at_end\":%zu,\"rate\":%g,"
                 "\"requests\":%zu,\"failures\":%zu,\"bytes\":%llu,\"seconds\":%.3f,"
                 "\"per_second\":%.1f,",
                 options->connections, options->active, polls->open, options->rate,
                 polls->request_count, polls->failure_count, (unsigned long long)polls->bytes,
                 elapsed, (double)polls->request_count / elapsed);
    samples_write(&polls->latency, stdout);
    (void)printf("}\n");
}

static bool requests_make(struct polls *polls)
{
    const struct polls_options *options = polls->options;
    polls->requests = calloc(options->path_count, sizeof *polls->requests);
    for (size_t index = 0; polls->requests != NULL && index < options->path_count; index++) {
        if (asprintf(&polls->requests[index], "GET %s HTTP/1.1\r\nHost: 127.0.0.1:%u\r\n\r\n",
                     options->paths[index], options->port) < 0)
            return false;
    }
    return polls->requests != NULL;
}

static void polls_release(struct polls *polls)
{
    const struct polls_options *options = polls->options;
    for (size_t index = 0; polls->connections != NULL && index < options->connections; index++) {
        if (polls->connections[index].descriptor > 0 && !polls->connections[index].broken)
            (void)close(polls->connections[index].descriptor);
    }
    for (size_t index = 0; polls->requests != NULL && index < options->path_count; index++)
        free(polls->requests[index]);
    if (polls->epoll >= 0)
        (void)close(polls->epoll);
    samples_release(&polls->latency);
    free(polls->connections);
    free(polls->requests);
    free(polls);
}

int polls_run(const struct polls_options *options)
{
    struct polls *polls = calloc(1, sizeof *polls);
    if (polls == NULL || !loadgen_reserve(options->connections)) {
        free(polls);
        return 1;
    }
    polls->options = options;
    polls->connections = calloc(options->connections, sizeof *polls->connections);
    polls->epoll = epoll_create1(EPOLL_CLOEXEC);
    bool good = polls->connections != NULL && polls->epoll >= 0 && requests_make(polls) &&
                connections_open(polls);
    if (!good)
        (void)fprintf(stderr, "talus-loadgen: %zu of %zu connections were opened and answered\n",
                      polls->open - polls->busy, options->connections);
    if (good)
        report(polls, measure(polls));
    good = good && !polls->latency.failed;
    polls_release(polls);
    return good ? 0 : 1;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "loadgen_watch.h"

#include "loadgen_answer.h"
#include "loadgen_lines.h"
#include "loadgen_samples.h"
#include "loadgen_socket.h"
#include "loadgen_story.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

enum { EVENTS_MAX = 256, READ_BYTES = 256 << 10 };

struct watcher {
    int descriptor; /* -1: closed */
    bool begun;
    struct answer answer;
    struct story story;
};

struct watch {
    const struct watch_options *options;
    struct watcher *watchers;
    int epoll;
    size_t begun, open;
    unsigned long long bytes;
    double ready; /* when all had begun [s since 1970], 0: not yet */
    char buffer[READ_BYTES];
};

static void watcher_close(struct watch *watch, struct watcher *watcher)
{
    (void)close(watcher->descriptor);
    watcher->descriptor = -1;
    watch->open--;
}

static void watcher_read(struct watch *watch, struct watcher *watcher)
{
    ssize_t length = recv(watcher->descriptor, watch->buffer, sizeof watch->buffer, 0);
    if (length > 0) {
        watcher->story.now = loadgen_date();
        watch->bytes += (unsigned long long)length;
        (void)answer_take(&watcher->answer, watch->buffer, (size_t)length, story_take,
                          &watcher->story);
    }
    if (!watcher->begun && watcher->answer.part != ANSWER_HEAD) {
        watcher->begun = true;
        watch->begun++;
    }
    if (length <= 0 || watcher->answer.broken || watcher->answer.part == ANSWER_END)
        watcher_close(watch, watcher);
}

static void watch_wait(struct watch *watch, int milliseconds)
{
    struct epoll_event events[EVENTS_MAX];
    int count = epoll_wait(watch->epoll, events, EVENTS_MAX, milliseconds);
    for (int index = 0; index < count; index++) {
        struct watcher *watcher = events[index].data.ptr;
        if (watcher->descriptor >= 0)
            watcher_read(watch, watcher);
    }
}

/* Opens the streams, at most 100 ahead of those that have begun. */
static bool watchers_open(struct watch *watch, const char *request, size_t length, double end)
{
    enum { AHEAD = 100 };
    for (size_t index = 0; index < watch->options->watchers; index++) {
        struct watcher *watcher = &watch->watchers[index];
        struct epoll_event event = {.events = EPOLLIN, .data = {.ptr = watcher}};
        watcher->descriptor = loadgen_connect(watch->options->port);
        if (watcher->descriptor < 0)
            return false;
        watch->open++;
        if (epoll_ctl(watch->epoll, EPOLL_CTL_ADD, watcher->descriptor, &event) != 0 ||
            !loadgen_send(watcher->descriptor, request, length))
            return false;
        while (index + 1 - watch->begun >= AHEAD && loadgen_now() < end)
            watch_wait(watch, 100);
    }
    while (watch->begun < watch->options->watchers && watch->open > 0 && loadgen_now() < end)
        watch_wait(watch, 100);
    return watch->begun == watch->options->watchers;
}

/* Lags of what came when everybody was there: an event told from a file that was there before is
 * as old as the file. */
static void lags_add(const struct watch *watch, const struct written_lines *lines,
                     struct samples *lags, double span[2])
{
    for (size_t index = 0; index < watch->options->watchers; index++) {
        const struct story *story = &watch->watchers[index].story;
        for (size_t place = 0; place < story->count; place++) {
            const struct story_event *event = &story->events[place];
            const struct written_line *line = written_lines_find(lines, event->offset);
            if (line == NULL || line->at <= watch->ready)
                continue;
            samples_add(lags, event->came - line->at);
            span[0] = span[0] > 0 && span[0] < event->came ? span[0] : event->came;
            span[1] = span[1] > event->came ? span[1] : event->came;
        }
    }
}

static bool report(struct watch *watch)
{
    const struct story *first = &watch->watchers[0].story;
    struct written_lines lines = {0};
    struct samples lags = {0};
    size_t complete = 0, different = 0, gaps = 0, fewest = first->count, most = first->count;
    double span[2] = {0, 0};
    bool good = written_lines_read(&lines, watch->options->lines);
    for (size_t index = 0; index < watch->options->watchers; index++) {
        const struct story *story = &watch->watchers[index].story;
        complete += story->done && watch->watchers[index].answer.part == ANSWER_END;
        different += !story_equal(story, first);
        gaps += story->is_gap;
        fewest = story->count < fewest ? story->count : fewest;
        most = story->count > most ? story->count : most;
        good = good && !story->failed;
    }
    lags_add(watch, &lines, &lags, span);
    (void)printf("{\"watchers\":%zu,\"complete\":%zu,\"fewest\":%zu,\"most\":%zu,"
                 "\"different\":%zu,\"gaps\":%zu,\"bytes\":%llu,\"live\":%zu,\"seconds\":%.3f,"
                 "\"per_second\":%.1f,",
                 watch->options->watchers, complete, fewest, most, different, gaps, watch->bytes,
                 lags.count, span[1] - span[0],
                 span[1] > span[0] ? (double)lags.count / (span[1] - span[0]) : 0);
    good = good && !lags.failed;
    samples_write(&lags, stdout);
    (void)printf("}\n");
    samples_release(&lags);
    written_lines_release(&lines);
    return good;
}

static bool watch_through(struct watch *watch)
{
    char request[1024];
    double end = loadgen_now() + watch->options->seconds;
    int length = snprintf(request, sizeof request,
                          "GET %s HTTP/1.1\r\nHost: 127.0.0.1:%u\r\nAccept: text/event-stream"
                          "\r\n\r\n",
                          watch->options->path, watch->options->port);
    if (length < 0 || (size_t)length >= sizeof request ||
        !watchers_open(watch, request, (size_t)length, end)) {
        (void)fprintf(stderr, "talus-loadgen: %zu of %zu streams have begun\n", watch->begun,
                      watch->options->watchers);
        return false;
    }
    watch->ready = loadgen_date();
    (void)printf("ready\n");
    (void)fflush(stdout);
    while (watch->open > 0 && loadgen_now() < end)
        watch_wait(watch, 100);
    return true;
}

int watch_run(const struct watch_options *options)
{
    struct watch *watch = calloc(1, sizeof *watch);
    if (watch == NULL || !loadgen_reserve(options->watchers)) {
        free(watch);
        return 1;
    }
    watch->options = options;
    watch->epoll = epoll_create1(EPOLL_CLOEXEC);
    watch->watchers = calloc(options->watchers, sizeof *watch->watchers);
    for (size_t index = 0; watch->watchers != NULL && index < options->watchers; index++)
        watch->watchers[index].descriptor = -1;
    bool good =
        watch->epoll >= 0 && watch->watchers != NULL && watch_through(watch) && report(watch);
    for (size_t index = 0; watch->watchers != NULL && index < options->watchers; index++) {
        if (watch->watchers[index].descriptor >= 0)
            (void)close(watch->watchers[index].descriptor);
        story_release(&watch->watchers[index].story);
    }
    if (watch->epoll >= 0)
        (void)close(watch->epoll);
    free(watch->watchers);
    free(watch);
    return good ? 0 : 1;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* What one reader of an event stream has been told: the ids of the events and when they came. */
#ifndef TALUS_LOADGEN_STORY_H
#define TALUS_LOADGEN_STORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { STORY_LINE_BYTES = 128 };

struct story_event {
    int64_t offset; /* behind the event's line in events.ndjson */
    uint64_t number;
    double came; /* [s since 1970] */
};

/* Zeroed is empty. Only the beginning of a line is kept; the stream's text is not. */
struct story {
    struct story_event *events;
    size_t count, capacity;
    char line[STORY_LINE_BYTES];
    size_t line_length;
    double now;   /* when the bytes at hand came */
    bool done;    /* the event `done` was told */
    bool is_done; /* the event that is being read is `done` */
    bool is_gap;  /* a gap was told: the reader was too slow */
    bool failed;
};

/* Takes bytes of the stream. `context` is the story. */
void story_take(void *context, const char *data, size_t length);
/* Whether two stories have the same events in the same order. */
bool story_equal(const struct story *one, const struct story *other);
void story_release(struct story *story);

#endif

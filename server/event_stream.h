/* SPDX-License-Identifier: Apache-2.0 */
/* A job's events.ndjson as Server-Sent Events. The id of an event is the byte offset behind its
 * line and its number among the events of that line, so a reader resumes exactly, in any daemon. */
#ifndef TALUS_EVENT_STREAM_H
#define TALUS_EVENT_STREAM_H

#include "event_log.h"
#include "history_reader.h"
#include "talus/status.h"
#include "text.h"

#include <stdbool.h>
#include <stdint.h>

struct event_id {
    int64_t offset;
    uint64_t number;
};

/* History rows from `row` on are void, says a line that ends at `end`. */
struct event_rewind {
    int64_t end, row;
};

/* Owns everything in it. */
struct event_stream {
    char *folder;
    struct event_tail tail;
    struct event_id after;        /* events up to this one are known to the reader */
    struct event_id last;         /* the last one produced */
    int64_t replay_end;           /* lines before this were there when the stream was opened */
    int64_t last_progress;        /* the only progress line of the replay that is told */
    struct event_rewind *rewinds; /* of the replay */
    size_t rewind_count;
    struct history_reader history;
    int64_t row;                /* rows of history that have been told */
    int64_t span_row, span_end; /* rows of the current history line still to be told */
    struct event_id span_next;  /* id of the first event of the next chunk */
    char *final_line;           /* the last line, if it is a final state */
    int64_t final_end;
    bool mute;       /* skip: count, but tell only states and rewinds */
    bool done;       /* `done` was told (or known): nothing follows */
    struct text out; /* produced, not taken yet */
};

/* "OFFSET-NUMBER"; false for anything else. */
bool event_id_parse(const char *text, struct event_id *id);
/* Opens the stream of a job's folder behind `after` ({0, 0}: from the start). TALUS_INVALID, code
 * "event_id", if there is no such place in the file. */
TALUS_MUST_CHECK enum talus_status event_stream_open(struct event_stream *stream,
                                                     const char *folder, struct event_id after,
                                                     struct talus_error *error);
/* Appends what is new to stream->out, pausing (true) when that exceeds about 64 KiB. */
bool event_stream_fill(struct event_stream *stream);
/* Passes over what a stalled reader missed and says so in one `gap` event. */
void event_stream_skip(struct event_stream *stream);
/* Bytes of the file behind what was read. */
int64_t event_stream_backlog(const struct event_stream *stream);
void event_stream_close(struct event_stream *stream);

#endif

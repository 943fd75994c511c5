/* SPDX-License-Identifier: Apache-2.0 */
/* What happens to a study and to its rows, as Server-Sent Events: `state` of the study, `row` of a
 * row, `done` when nothing follows. Ids are the numbers of transitions, valid across restarts. */
#ifndef TALUS_STUDY_STREAM_H
#define TALUS_STUDY_STREAM_H

#include "store.h"
#include "text.h"

#include <stdbool.h>
#include <stdint.h>

/* Used by one thread. Owns `out`. */
struct study_stream {
    struct store *store; /* borrowed */
    char id[64];
    int64_t row;      /* told so far */
    bool paused;      /* there was more than fits at once */
    bool looked;      /* `commits` is known */
    uint64_t commits; /* of the store, when it was last looked at */
    bool done;        /* `done` was told */
    struct text out;  /* produced, not taken yet */
};

/* Reads on behind a transition (0: from the start). */
void study_stream_open(struct study_stream *stream, struct store *store, const char *id,
                       int64_t after);
/* Appends what is new, about 64 KiB at a time. */
void study_stream_fill(struct study_stream *stream);
/* Bytes that wait, roughly. */
int64_t study_stream_backlog(struct study_stream *stream);
/* Leaves out what waits, and says so by a `gap`. */
void study_stream_skip(struct study_stream *stream);
void study_stream_close(struct study_stream *stream);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* What happens to all jobs and studies, as Server-Sent Events: the rows of the store's transition
 * tables, which are their ids, and the progress of running jobs, which has none. What is new is
 * written once and copied to every reader; only those who lag behind read the store themselves. */
#ifndef TALUS_FEED_H
#define TALUS_FEED_H

#include "store.h"
#include "talus/status.h"
#include "text.h"

#include <jansson.h>

struct feed;

/* *store is borrowed. */
TALUS_MUST_CHECK enum talus_status feed_create(struct feed **feed, struct store *store,
                                               struct talus_error *error);
/* NULL is fine; nobody may read any more. */
void feed_destroy(struct feed *feed);
/* Takes over what the store has that is new. */
void feed_refresh(struct feed *feed);
/* The progress of a job, for those who listen now. */
void feed_progress(struct feed *feed, const char *job, const json_t *progress);

/* One reader; used by one thread. Owns `out`. */
struct feed_reader {
    struct feed *feed;
    int64_t row;       /* told so far */
    uint64_t progress; /* told or left out so far */
    struct text out;   /* produced, not taken yet */
};

/* Reads on behind a row (0: from the first one there is). */
void feed_reader_open(struct feed_reader *reader, struct feed *feed, int64_t row);
/* The last row there is. */
int64_t feed_last(struct feed *feed);
/* Appends what is new, at most about 64 KiB at a time. */
void feed_reader_fill(struct feed_reader *reader);
/* Bytes that wait for this reader, roughly. */
int64_t feed_reader_backlog(struct feed_reader *reader);
/* Leaves out what waits, and says so by a `gap`. */
void feed_reader_skip(struct feed_reader *reader);
void feed_reader_close(struct feed_reader *reader);

#endif

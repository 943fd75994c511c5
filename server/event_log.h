/* SPDX-License-Identifier: Apache-2.0 */
/* The daemon's side of a job's events.ndjson and job.lock. The holder of the lock is the only
 * writer of the events. */
#ifndef TALUS_EVENT_LOG_H
#define TALUS_EVENT_LOG_H

#include "store.h"
#include "text.h"

#include <jansson.h>

/* Takes a job's lock: the descriptor that holds it, -1 if somebody else does (errno EWOULDBLOCK) or
 * it cannot be opened. Close it to let go. */
int event_log_lock(const char *folder);
/* One `state` line, newline included. */
void event_log_state_line(struct text *text, const struct store_transition *transition);
/* Under the lock: cuts a torn last line, then appends a `state` line for every transition of the
 * store that the file lacks, and flushes. */
TALUS_MUST_CHECK enum talus_status event_log_repair(struct store *store, const char *id,
                                                    const char *folder, struct talus_error *error);
/* The number of the state line that ends the file, 0 if the last line is another or torn. */
int64_t event_log_last_number(const char *folder);

/* Reads a growing file of lines from `offset` on. */
struct event_tail {
    int descriptor; /* -1: not open yet */
    int64_t offset; /* behind the last complete line that was read */
};

/* Reads what is complete by now and visits each line (NUL-terminated, without the newline; `end` is
 * the offset behind it) until `visit` is false. A file that is not there is empty. */
TALUS_MUST_CHECK enum talus_status event_tail_read(struct event_tail *tail, const char *folder,
                                                   bool (*visit)(char *line, size_t length,
                                                                 int64_t end, void *context),
                                                   void *context, struct talus_error *error);
void event_tail_close(struct event_tail *tail);

#endif

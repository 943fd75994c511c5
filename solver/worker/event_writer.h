/* SPDX-License-Identifier: Apache-2.0 */
/* events.ndjson: what the worker tells the world (base/protocol.h). The holder of the job's lock is
 * its only writer. A line is complete or absent: one write(2) each, and a line torn by a crash is
 * cut when the file is opened. Several threads may write events and sync. */
#ifndef TALUS_EVENT_WRITER_H
#define TALUS_EVENT_WRITER_H

#include "base/protocol.h"
#include "talus/status.h"

#include <jansson.h>
#include <pthread.h>

struct event_writer {
    int descriptor;        /* below 0: closed */
    int attempt;           /* of the lines that are written */
    int last_attempt;      /* highest attempt found in the file when it was opened; 0: none */
    pthread_mutex_t mutex; /* one line after the other, in the order of their times */
};

TALUS_MUST_CHECK enum talus_status event_open(struct event_writer *writer, const char *folder,
                                              struct talus_error *error);
/* Appends {"event", "at", "attempt", ...fields}; takes over `fields` (NULL: memory ran out). */
TALUS_MUST_CHECK enum talus_status event_write(struct event_writer *writer,
                                               enum protocol_message message, json_t *fields,
                                               struct talus_error *error);
TALUS_MUST_CHECK enum talus_status event_sync(struct event_writer *writer,
                                              struct talus_error *error);
void event_close(struct event_writer *writer);

/* The number as JSON, null if it is not finite; new reference. */
json_t *event_number(double value);

enum { EVENT_TIME_SIZE = 48 };
/* Now, as RFC 3339 UTC with microseconds. */
void event_time(char text[EVENT_TIME_SIZE]);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* What one reader of a story is told next, every other reader at the same place is told too. While
 * all readers are looked at in turn, the first one at a place reads the files, and the others copy
 * what came of it. */
#ifndef TALUS_EVENT_STEPS_H
#define TALUS_EVENT_STEPS_H

#include "event_stream.h"

/* The steps of one look at all readers; zeroed is none. */
struct event_steps {
    struct event_step *first;
};

/* As event_stream_fill. */
void event_steps_fill(struct event_steps *steps, struct event_stream *stream);
/* Forgets them: files grow. */
void event_steps_clear(struct event_steps *steps);

#endif

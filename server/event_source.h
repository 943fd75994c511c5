/* SPDX-License-Identifier: Apache-2.0 */
/* What a reader of events reads: the story of one job or study, or the feed of all. */
#ifndef TALUS_EVENT_SOURCE_H
#define TALUS_EVENT_SOURCE_H

#include "event_steps.h"
#include "feed.h"
#include "studies/study_stream.h"

enum event_source_kind { SOURCE_JOB, SOURCE_STUDY, SOURCE_ALL };

/* Owns what it reads from, which the kind tells. */
struct event_source {
    enum event_source_kind kind;
    struct event_stream stream;
    struct study_stream study;
    struct feed_reader reader;
};

/* Produced and not taken yet. */
struct text *event_source_out(struct event_source *source);
/* Appends what is new, which other readers of the same story may have been told already. */
void event_source_fill(struct event_source *source, struct event_steps *steps);
/* Leaves out what waits, and says so by a `gap`. */
void event_source_skip(struct event_source *source);
/* Bytes that wait. */
int64_t event_source_backlog(struct event_source *source);
/* Whether nothing follows. */
bool event_source_done(const struct event_source *source);
void event_source_close(struct event_source *source);

#endif

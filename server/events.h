/* SPDX-License-Identifier: Apache-2.0 */
/* Streams of events to readers: one thread follows the files and fills the streams; the HTTP thread
 * only copies bytes. */
#ifndef TALUS_EVENTS_H
#define TALUS_EVENTS_H

#include "event_source.h"
#include "request.h"
#include "talus/status.h"

struct events;

/* *service is borrowed. */
TALUS_MUST_CHECK enum talus_status events_create(struct events **events, struct service *service,
                                                 struct talus_error *error);
/* Every stream must have been ended and its connection closed. NULL is fine. */
void events_destroy(struct events *events);
/* Answers a request with what a source has, which is taken over. */
void events_subscribe(struct events *events, struct request *request,
                      const struct event_source *source);
/* The feed of all jobs. */
struct feed *events_feed(struct events *events);
/* Open streams. */
size_t events_reader_count(struct events *events);
/* Looks at the files now. */
void events_wake(struct events *events);
/* Ends the streams whose token is not in force any more. */
void events_access_recheck(struct events *events);
/* Ends all streams and lets no new one last. */
void events_end(struct events *events);

#endif

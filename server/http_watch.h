/* SPDX-License-Identifier: Apache-2.0 */
/* An absolute deadline for the arrival of requests: the idle timeout of the HTTP library starts
 * again with every byte, so a client could hold a connection for ever. */
#ifndef TALUS_HTTP_WATCH_H
#define TALUS_HTTP_WATCH_H

#include "talus/status.h"

struct http_watch;
struct connection_watch;

TALUS_MUST_CHECK enum talus_status http_watch_create(struct http_watch **watch, double seconds,
                                                     struct talus_error *error);
/* All connections must be gone. NULL is fine. */
void http_watch_destroy(struct http_watch *watch);
/* A connection is open (NULL without memory), and closed: afterwards its descriptor is not touched
 * any more. */
struct connection_watch *http_watch_open(struct http_watch *watch, int descriptor);
void http_watch_closed(struct connection_watch *connection);
/* A request has arrived in full; the connection is free for the next one. */
void http_watch_arrived(struct connection_watch *connection);
void http_watch_idle(struct connection_watch *connection);

#endif

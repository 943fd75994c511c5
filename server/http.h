/* SPDX-License-Identifier: Apache-2.0 */
/* The HTTP server: one epoll thread of libmicrohttpd that never waits. It checks what the library
 * lets pass, collects bodies, and hands requests to the lanes. */
#ifndef TALUS_HTTP_H
#define TALUS_HTTP_H

#include "service.h"

struct http_server;

/* Starts serving on a listening socket, which is taken over. *service is borrowed. */
TALUS_MUST_CHECK enum talus_status http_start(struct http_server **server, struct service *service,
                                              int listener, struct talus_error *error);
/* Answers every further request with 503 at once, so that none is suspended any more. */
void http_close(struct http_server *server);
/* Ends the thread and closes all connections; none may be suspended. NULL is fine. */
void http_stop(struct http_server *server);

#endif

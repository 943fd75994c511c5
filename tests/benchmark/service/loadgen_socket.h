/* SPDX-License-Identifier: Apache-2.0 */
/* What every kind of load needs: the clocks, room for descriptors, and connections to a port of
 * 127.0.0.1. */
#ifndef TALUS_LOADGEN_SOCKET_H
#define TALUS_LOADGEN_SOCKET_H

#include <stdbool.h>
#include <stddef.h>

/* Seconds of a clock that only goes forward; seconds since 1970. */
double loadgen_now(void);
double loadgen_date(void);
/* Raises the limit of open files to its hard limit. False, with what to do on stderr, if fewer than
 * `count` connections fit. */
bool loadgen_reserve(size_t count);
/* A connection that does not block once it is made, or -1 with the reason on stderr. */
int loadgen_connect(unsigned port);
/* Sends a few bytes on a connection that has nothing in its way. */
bool loadgen_send(int descriptor, const char *data, size_t length);

#endif

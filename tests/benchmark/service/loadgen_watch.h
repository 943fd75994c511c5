/* SPDX-License-Identifier: Apache-2.0 */
/* Many readers of one job's event stream. */
#ifndef TALUS_LOADGEN_WATCH_H
#define TALUS_LOADGEN_WATCH_H

#include <stddef.h>

struct watch_options {
    unsigned port;
    const char *path;  /* of the stream */
    const char *lines; /* the job's events.ndjson, for the times its lines were written */
    size_t watchers;
    double seconds; /* at most */
};

/* Opens the streams, prints "ready" on a line once every one has begun, reads until all have ended,
 * and prints one line of JSON: watchers, complete (streams that ended by themselves with `done`),
 * events of a stream (fewest, most), different (stories that are not the first watcher's, id by
 * id), bytes, seconds, delivered per second while events came, and the percentiles of the lag: from
 * the "at" of an event's line to the moment its bytes were read. Returns the exit code. */
int watch_run(const struct watch_options *options);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_WATCH_H
#define TALUS_WATCH_H

#include "connection.h"

/* Follows a job to its end: progress and forces live on a terminal, as plain lines otherwise, as
 * one JSON object an event with --json. Connections that break are taken up again where they were
 * (Last-Event-ID). `only`: a reaction to show ("column.x_min"); NULL: all boundaries.
 * Returns an exit code: EXIT_JOB_FAILED if the job failed or was cancelled, EXIT_NO_SERVER if the
 * server cannot be reached for a minute. */
int watch_job(struct connection *connection, const char *id, const char *only);

#endif

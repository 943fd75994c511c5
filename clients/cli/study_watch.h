/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_STUDY_WATCH_H
#define TALUS_STUDY_WATCH_H

#include "connection.h"

/* Follows a study to its end: its progress live on a terminal, as plain lines otherwise, as one
 * JSON object a change with --json. Returns an exit code: EXIT_JOB_FAILED if the study failed or
 * was cancelled, EXIT_NO_SERVER if the server cannot be reached for a minute. */
int study_watch(struct connection *connection, const char *id);

#endif

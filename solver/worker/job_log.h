/* SPDX-License-Identifier: Apache-2.0 */
/* log.txt: a line for people about everything that matters, and the same on stderr for whoever
 * sits before it (not when stderr is log.txt already, as under the daemon). */
#ifndef TALUS_JOB_LOG_H
#define TALUS_JOB_LOG_H

#include "talus/status.h"

#include <stdbool.h>

struct job_log {
    int descriptor;                 /* below 0: closed */
    bool echo, terminal, line_open; /* a progress line without newline is on the terminal */
};

TALUS_MUST_CHECK enum talus_status job_log_open(struct job_log *log, const char *folder, bool quiet,
                                                struct talus_error *error);
/* Appends "TIME LEVEL TEXT". A log that cannot be written is no reason to end a run. */
void job_log_write(struct job_log *log, const char *level, const char *text);
/* Shows progress: overwrites the last one on a terminal, else a line of its own. */
void job_log_progress(struct job_log *log, const char *text, bool last);
void job_log_close(struct job_log *log);

#endif

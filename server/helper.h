/* SPDX-License-Identifier: Apache-2.0 */
/* A `talus-worker helper` process: one JSON line in, one JSON line out. It reads what strangers
 * send, so it has limits, and is replaced when dead, late, or old. Used by one thread at a time. */
#ifndef TALUS_HELPER_H
#define TALUS_HELPER_H

#include "config.h"
#include "talus/status.h"

#include <jansson.h>
#include <sys/types.h>

struct helper {
    const struct config *config; /* borrowed */
    pid_t pid;                   /* 0: not running */
    int in, out;                 /* its standard input and output */
    int answer_count;
};

/* Starts nothing: the process is started when it is first asked. */
void helper_init(struct helper *helper, const struct config *config);
/* Asks, and waits at most `seconds`. *answer is a new reference to an object. TALUS_LIMIT, code
 * "late"; TALUS_IO, code "helper", if it died or cannot be started. Either way the next question
 * goes to a new process. */
TALUS_MUST_CHECK enum talus_status helper_ask(struct helper *helper, const json_t *question,
                                              double seconds, json_t **answer,
                                              struct talus_error *error);
void helper_stop(struct helper *helper);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_JOB_ACTION_H
#define TALUS_JOB_ACTION_H

#include "arguments.h"
#include "connection.h"

/* Sends METHOD /v1/jobs/ID + suffix for every operand and says what became of each job. Goes on
 * after a refusal; returns the worst exit code. */
int job_action_run(struct connection *connection, const struct arguments *arguments,
                   const char *method, const char *suffix);
/* The same for some ids of another collection than "jobs". */
int resource_action_run(struct connection *connection, const char *collection, char *const *ids,
                        int count, const char *method, const char *suffix);

#endif

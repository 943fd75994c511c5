/* SPDX-License-Identifier: Apache-2.0 */
/* What is counted while the daemon runs, for /metrics. */
#ifndef TALUS_SERVICE_METRICS_H
#define TALUS_SERVICE_METRICS_H

#include "job.h"
#include "request.h"
#include "talus/status.h"
#include "text.h"

#include <stdbool.h>

struct metrics;

TALUS_MUST_CHECK enum talus_status metrics_create(struct metrics **metrics,
                                                  struct talus_error *error);
/* NULL is fine. */
void metrics_destroy(struct metrics *metrics);
/* A request whose answer, or the beginning of it, is ready. */
void metrics_request(struct metrics *metrics, const struct request *request);
/* An attempt begins (`again`: it is not the job's first), and ends. */
void metrics_attempt_begin(struct metrics *metrics, bool again);
void metrics_attempt_end(struct metrics *metrics, enum job_end end);
/* Everything that was counted, in Prometheus' text format. */
void metrics_print(struct metrics *metrics, struct text *text);
/* The lines before the samples of a metric: its help and its type. */
void metrics_print_head(struct text *text, const char *name, const char *type, const char *help);

#endif

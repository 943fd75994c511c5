/* SPDX-License-Identifier: Apache-2.0 */
/* Jobs as the server describes them, in words. */
#ifndef TALUS_JOB_TEXT_H
#define TALUS_JOB_TEXT_H

#include <jansson.h>
#include <stddef.h>
#include <stdio.h>

/* A member that is a string, "" if there is none. */
const char *json_text(const json_t *object, const char *key);

/* Everything about one job, over several lines. */
void job_print(FILE *stream, const json_t *job);
/* What is left to say when a job has ended: state, reason, figures; of forces only the peaks that
 * are not zero. */
void job_print_result(FILE *stream, const json_t *job);
/* Advice and warnings: what a scene models more, or less, than it needs. */
void job_print_advice(FILE *stream, const json_t *job);
/* The forecast in one line, if there is one. */
void job_print_forecast(FILE *stream, const json_t *job);

/* "42.1 %  t = 1.474 s  step 2948  3.10 M particle-steps/s  1 min 20 s left" */
void progress_format(const json_t *progress, char *text, size_t size);
/* "45 s", "1 min 20 s", "2 h 5 min" */
void duration_format(double seconds, char *text, size_t size);
/* "512 B", "1.2 MB" */
void bytes_format(double bytes, char *text, size_t size);

/* EXIT_DONE for `succeeded`, else EXIT_JOB_FAILED. */
int job_exit_code(const json_t *job);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* The body of a submission or a forecast: what surrounds the scene. */
#ifndef TALUS_SUBMISSION_H
#define TALUS_SUBMISSION_H

#include "job.h"
#include "json_field.h"

#include <jansson.h>

/* Reads everything but the scene into an empty *job and adds each mistake to *errors. `workers` is
 * the largest number of threads that can run. *scene is borrowed, NULL if it is missing. */
void submission_read(const json_t *body, int64_t workers, struct job *job, const json_t **scene,
                     json_t *errors);
/* The part of it that may change later, labels, limits and priority, into a job whose own are
 * replaced. */
void submission_settings_read(const json_t *settings, struct job *job, json_t *errors);
/* Whether a body asks for `reuse`. */
bool submission_reuse(const json_t *body);

/* Takes over what a helper found about the scene: forecast, advice, warnings, hash. `threads` 0
 * becomes as many as the forecast says pay, `workers` at most. */
TALUS_MUST_CHECK enum talus_status submission_answer_take(struct job *job, const json_t *answer,
                                                          double workers,
                                                          struct talus_error *error);

/* For the tables of other bodies: the offsets are those of a job. */
extern const struct json_field submission_labels, submission_limits, submission_priority,
    submission_threads, submission_retries;
enum { SUBMISSION_NAME_CHARACTERS = 256 };

#endif

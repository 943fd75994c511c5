/* SPDX-License-Identifier: Apache-2.0 */
/* The body of a submission or a forecast: what surrounds the scene. */
#ifndef TALUS_SUBMISSION_H
#define TALUS_SUBMISSION_H

#include "job.h"
#include "json_field.h"

#include <jansson.h>
#include <stddef.h>

/* Reads everything but the scene into an empty *job and adds each mistake to *errors. `workers` is
 * the largest number of threads that can run. *scene is borrowed, NULL if it is missing. */
void submission_read(const json_t *body, int64_t workers, struct job *job, const json_t **scene,
                     json_t *errors);
/* The part of it that may change later, labels, limits and priority, into a job whose own are
 * replaced. */
void submission_settings_read(const json_t *settings, struct job *job, json_t *errors);
/* Adds a mistake if a body asks for more threads than can run. */
void submission_threads_check(const json_t *body, int64_t threads, int64_t workers, json_t *errors);
/* Whether a body asks for `reuse`. */
bool submission_reuse(const json_t *body);

/* Takes over what a helper found about the scene: forecast, advice, warnings, hash. `threads` 0
 * becomes as many as the forecast says pay, `workers` at most. */
TALUS_MUST_CHECK enum talus_status submission_answer_take(struct job *job, const json_t *answer,
                                                          double workers,
                                                          struct talus_error *error);

extern const struct json_field submission_labels, submission_limits, submission_priority,
    submission_threads, submission_retries;
enum { SUBMISSION_NAME_CHARACTERS = 256 };

/* For the tables of bodies that are read into a job: what may change later ... */
#define SUBMISSION_SETTINGS                                                                        \
    SUBMISSION_FIELD(labels), SUBMISSION_FIELD(priority),                                          \
    {                                                                                              \
        .key = "limits", .kind = FIELD_SAME, .optional = true, .item = &submission_limits          \
    }
/* ... and all that means the same for a job and for those of a study. */
#define SUBMISSION_FIELDS(name_optional)                                                           \
    {.key = "scene", .kind = FIELD_SCENE, .offset = FIELD_NOWHERE},                                \
        {.key = "name",                                                                            \
         .kind = FIELD_TEXT,                                                                       \
         .optional = (name_optional),                                                              \
         .most = SUBMISSION_NAME_CHARACTERS,                                                       \
         .offset = offsetof(struct job, name),                                                     \
         .meaning = "for people"},                                                                 \
        SUBMISSION_SETTINGS, SUBMISSION_FIELD(threads), SUBMISSION_FIELD(retries)
#define SUBMISSION_FIELD(member)                                                                   \
    {                                                                                              \
        .key = #member, .kind = FIELD_SAME, .optional = true, .item = &submission_##member,        \
        .offset = offsetof(struct job, member)                                                     \
    }

#endif

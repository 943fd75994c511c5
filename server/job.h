/* SPDX-License-Identifier: Apache-2.0 */
/* A job, and the only ways in which its state changes. Nothing here touches files, the store or the
 * clock's meaning: the store applies these functions inside a transaction. */
#ifndef TALUS_JOB_H
#define TALUS_JOB_H

#include "talus/status.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

enum job_state {
#define JOB_STATE(ENUM, name, final) JOB_##ENUM,
#include "job_states.def"
#undef JOB_STATE
    JOB_STATE_COUNT
};

/* Owns its texts. A zeroed job is empty. */
struct job {
    char *id;
#define JOB_TEXT(name) char *name;
#define JOB_INTEGER(name) int64_t name;
#define JOB_REAL(name) double name;
#include "job_columns.def"
#undef JOB_TEXT
#undef JOB_INTEGER
#undef JOB_REAL
};

/* How an attempt ended. */
enum job_end {
    JOB_END_SUCCEEDED,
    JOB_END_FAILED,    /* final, with a reason */
    JOB_END_CANCELLED, /* final */
    JOB_END_CRASHED,   /* retried, then final */
    JOB_END_LOST,      /* resumed without counting */
};

/* Texts are borrowed; JSON is borrowed; NULL: none. */
struct job_outcome {
    enum job_end end;
    const char *reason, *detail;
    int exit_code, signal_number; /* -1: not known */
    json_t *metrics, *receipt, *progress;
};

extern const char *const job_state_words[]; /* in the order of the enum, then NULL */
const char *job_state_name(enum job_state state);
/* JOB_STATE_COUNT if there is none of that name. */
enum job_state job_state_find(const char *name);
bool job_state_final(enum job_state state);

void job_release(struct job *job);
/* Replaces a text by a copy (NULL: by none). */
TALUS_MUST_CHECK enum talus_status job_text_set(char **text, const char *value,
                                                struct talus_error *error);
/* Its limits as a client gives them; new reference. */
json_t *job_limits_json(const struct job *job);
/* Replaces a text by a JSON document. */
TALUS_MUST_CHECK enum talus_status job_json_set(char **text, const json_t *value,
                                                struct talus_error *error);

/* A new job enters the queue. */
TALUS_MUST_CHECK enum talus_status job_enter(struct job *job, struct talus_error *error);
/* queued -> running, as attempt number job->attempt + 1. TALUS_LIMIT (code "state") if it is not
 * queued any more. */
TALUS_MUST_CHECK enum talus_status job_begin(struct job *job, const char *boot,
                                             struct talus_error *error);
/* running -> what the outcome says; a crash goes back to the queue while retries are left. */
TALUS_MUST_CHECK enum talus_status job_finish(struct job *job, const struct job_outcome *outcome,
                                              struct talus_error *error);
/* queued -> cancelled; running: notes the request. TALUS_LIMIT (code "state") if it has ended
 * otherwise; nothing changes if it is cancelled already. */
TALUS_MUST_CHECK enum talus_status job_cancel(struct job *job, struct talus_error *error);
/* failed or cancelled -> queued; else TALUS_LIMIT (code "state"). */
TALUS_MUST_CHECK enum talus_status job_resume(struct job *job, struct talus_error *error);
/* Marks a finished job for removal; TALUS_LIMIT (code "state") while it is active. */
TALUS_MUST_CHECK enum talus_status job_mark_deleted(struct job *job, struct talus_error *error);

#endif

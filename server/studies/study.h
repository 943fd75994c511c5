/* SPDX-License-Identifier: Apache-2.0 */
/* A study: a set of jobs from one scene. It is `running` until every row has ended (a bisection:
 * until the edge is found), and final from then on. Rows follow their jobs in the same transaction.
 */
#ifndef TALUS_STUDY_H
#define TALUS_STUDY_H

#include "job.h"
#include "study_design.h"
#include "talus/status.h"

#include <stdbool.h>
#include <stdint.h>

enum study_state {
#define STUDY_STATE(ENUM, name) STUDY_##ENUM,
#include "study_states.def"
#undef STUDY_STATE
    STUDY_STATE_COUNT
};

enum row_state {
#define ROW_STATE(ENUM, name) ROW_##ENUM,
#include "row_states.def"
#undef ROW_STATE
    ROW_STATE_COUNT
};

/* Owns its texts. A zeroed study is empty. */
struct study {
    char *id;
    int64_t counts[ROW_STATE_COUNT]; /* rows in each state */
#define STUDY_TEXT(name) char *name;
#define STUDY_LONG_TEXT(name) char *name;
#define STUDY_INTEGER(name) int64_t name;
#include "study_columns.def"
#undef STUDY_TEXT
#undef STUDY_LONG_TEXT
#undef STUDY_INTEGER
};

/* One row. Texts are borrowed; NULL: none. */
struct study_row {
    int64_t number; /* from 0 */
    enum row_state state;
    bool reused;
    const char *parameters, *settings; /* JSON objects: NAME -> value, JSON Pointer -> value */
    const char *job, *reason, *detail;
    const char *metrics; /* JSON object */
};

/* All names, NULL-terminated. */
extern const char *const study_state_words[], *const row_state_words[];
const char *study_state_name(enum study_state state);
/* STUDY_STATE_COUNT if there is none of that name. */
enum study_state study_state_find(const char *name);
const char *study_kind_name(enum study_kind kind);
const char *row_state_name(enum row_state state);
enum row_state row_state_of_job(enum job_state state);
/* Rows that are jobs and have not ended. */
int64_t study_active_count(const struct study *study);
/* Rows that have ended. */
int64_t study_ended_count(const struct study *study);
void study_release(struct study *study);
/* The wanted metrics out of all those of a job (JSON text or NULL), as JSON text: free() it; NULL
 * if there are none, or without memory. What the job does not have is left out. */
char *study_metrics_pick(const char *wanted, const char *metrics);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* The rows of studies inside a transaction of the store. */
#ifndef TALUS_STUDY_ROWS_H
#define TALUS_STUDY_ROWS_H

#include "store_internal.h"
#include "studies/study_store.h"

/* Appends rows (struct study_plan) behind the `count` rows that a study has, all waiting. */
TALUS_MUST_CHECK enum talus_status study_rows_append(sqlite3 *database, const char *study,
                                                     int64_t count, const json_t *rows,
                                                     struct talus_error *error);
/* Cancels every row that waits. */
TALUS_MUST_CHECK enum talus_status study_rows_cancel(sqlite3 *database, const char *study,
                                                     const char *at, struct talus_error *error);
/* Ends a row that waits; TALUS_LIMIT, code "state", if it does not. */
TALUS_MUST_CHECK enum talus_status study_row_end(sqlite3 *database, const struct row_end *end,
                                                 struct talus_error *error);
/* A new job takes its place in its study, if it has one. TALUS_LIMIT, code "state", if the row does
 * not wait (any more). */
TALUS_MUST_CHECK enum talus_status study_row_enter(sqlite3 *database, const struct job *job,
                                                   struct talus_error *error);
/* The row of a job whose state has changed follows, if the job is one of a study. */
TALUS_MUST_CHECK enum talus_status study_row_follow(sqlite3 *database, const struct job *job,
                                                    struct talus_error *error);
/* Adds a transition of a study (number -1) or of a row. */
TALUS_MUST_CHECK enum talus_status study_transition_write(sqlite3 *database, const char *study,
                                                          const struct study_transition *transition,
                                                          struct talus_error *error);

#endif

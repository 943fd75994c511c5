/* SPDX-License-Identifier: Apache-2.0 */
/* One row of the table of jobs, generated from job_columns.def. */
#ifndef TALUS_STORE_ROW_H
#define TALUS_STORE_ROW_H

#include "job.h"
#include "store_internal.h"

/* "SELECT every column": the rest follows. */
extern const char store_row_select[];
/* Fills an empty job from a row of that statement. */
void store_row_read(sqlite3_stmt *statement, struct job *job);
/* Inserts or replaces the row of a job. */
TALUS_MUST_CHECK enum talus_status store_row_write(sqlite3 *database, const struct job *job,
                                                   struct talus_error *error);

#endif

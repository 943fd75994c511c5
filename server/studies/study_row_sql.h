/* SPDX-License-Identifier: Apache-2.0 */
/* One row of the table of studies, generated from study_columns.def. */
#ifndef TALUS_STUDY_ROW_SQL_H
#define TALUS_STUDY_ROW_SQL_H

#include "store_internal.h"
#include "studies/study.h"
#include "text.h"

/* "SELECT every column FROM studies", the long texts being NULL in the second. */
extern const char study_select_whole[], study_select_light[];
/* Fills an empty study from a row of one of these. */
void study_row_read(sqlite3_stmt *statement, struct study *study);
/* Inserts a study that has no rows yet. */
TALUS_MUST_CHECK enum talus_status study_row_insert(sqlite3 *database, const struct study *study,
                                                    struct talus_error *error);

#endif

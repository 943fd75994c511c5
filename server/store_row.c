/* SPDX-License-Identifier: Apache-2.0 */
#include "store_row.h"

#define JOB_TEXT(name) ", " #name
#define JOB_INTEGER(name) JOB_TEXT(name)
#define JOB_REAL(name) JOB_TEXT(name)
const char store_row_select[] = "SELECT id"
#include "job_columns.def"
    ;
static const char replace_sql[] = "INSERT INTO jobs (id"
#include "job_columns.def" /* NOLINT(readability-duplicate-include) */
                                  ") VALUES (?"
#undef JOB_TEXT
#define JOB_TEXT(name) ", ?"
#include "job_columns.def"
                                  ") ON CONFLICT (id) DO UPDATE SET id = excluded.id"
#undef JOB_TEXT
#define JOB_TEXT(name) ", " #name " = excluded." #name
#include "job_columns.def"
    ;
#undef JOB_TEXT
#undef JOB_INTEGER
#undef JOB_REAL

void store_row_read(sqlite3_stmt *statement, struct job *job)
{
    int column = 1;
    job->id = store_column_copy(statement, 0);
#define JOB_TEXT(name) job->name = store_column_copy(statement, column++);
#define JOB_INTEGER(name) job->name = sqlite3_column_int64(statement, column++);
#define JOB_REAL(name) job->name = sqlite3_column_double(statement, column++);
#include "job_columns.def"
#undef JOB_TEXT
#undef JOB_INTEGER
#undef JOB_REAL
}

static void row_bind(sqlite3_stmt *statement, const struct job *job)
{
    int parameter = 2;
    (void)sqlite3_bind_text(statement, 1, job->id, -1, SQLITE_STATIC);
#define JOB_TEXT(name)                                                                             \
    (void)sqlite3_bind_text(statement, parameter++, job->name, -1, SQLITE_STATIC);
#define JOB_INTEGER(name) (void)sqlite3_bind_int64(statement, parameter++, job->name);
#define JOB_REAL(name) (void)sqlite3_bind_double(statement, parameter++, job->name);
#include "job_columns.def"
#undef JOB_TEXT
#undef JOB_INTEGER
#undef JOB_REAL
}

enum talus_status store_row_write(sqlite3 *database, const struct job *job,
                                  struct talus_error *error)
{
    sqlite3_stmt *statement = store_prepare(database, replace_sql, error);
    if (statement != NULL)
        row_bind(statement, job);
    return store_finish(database, statement, error);
}

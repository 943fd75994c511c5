/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_row_sql.h"

#include <stdlib.h>
#include <string.h>

#define STUDY_TEXT(name) ", " #name
#define STUDY_INTEGER(name) ", " #name
#define STUDY_LONG_TEXT(name) ", " #name
#define ROW_STATE(ENUM, name) ", " #name
const char study_select_whole[] = "SELECT id"
#include "row_states.def"
#include "study_columns.def"
                                  " FROM studies";
#undef ROW_STATE
static const char insert_begin[] = "INSERT INTO studies (id"
#include "study_columns.def"
                                   ") VALUES (?";
#undef STUDY_LONG_TEXT
#define STUDY_LONG_TEXT(name) ", NULL"
#define ROW_STATE(ENUM, name) ", " #name
const char study_select_light[] = "SELECT id"
#include "row_states.def"
#include "study_columns.def"
                                  " FROM studies";
#undef STUDY_TEXT
#undef STUDY_INTEGER
#undef STUDY_LONG_TEXT
#undef ROW_STATE
#define STUDY_TEXT(name) ", ?"
#define STUDY_INTEGER(name) ", ?"
#define STUDY_LONG_TEXT(name) ", ?"
static const char insert_values[] =
#include "study_columns.def"
    ")";
#undef STUDY_TEXT
#undef STUDY_INTEGER
#undef STUDY_LONG_TEXT

static char *column_text(sqlite3_stmt *statement, int column)
{
    const char *value = (const char *)sqlite3_column_text(statement, column);
    return value == NULL ? NULL : strdup(value);
}

void study_row_read(sqlite3_stmt *statement, struct study *study)
{
    int column = 0;
    study->id = column_text(statement, column++);
    for (size_t state = 0; state < ROW_STATE_COUNT; state++)
        study->counts[state] = sqlite3_column_int64(statement, column++);
#define STUDY_TEXT(name) study->name = column_text(statement, column++);
#define STUDY_LONG_TEXT(name) study->name = column_text(statement, column++);
#define STUDY_INTEGER(name) study->name = sqlite3_column_int64(statement, column++);
#include "study_columns.def"
#undef STUDY_TEXT
#undef STUDY_LONG_TEXT
#undef STUDY_INTEGER
}

static void row_bind(sqlite3_stmt *statement, const struct study *study)
{
    int parameter = 2;
    (void)sqlite3_bind_text(statement, 1, study->id, -1, SQLITE_STATIC);
#define STUDY_TEXT(name)                                                                           \
    (void)sqlite3_bind_text(statement, parameter++, study->name, -1, SQLITE_STATIC);
#define STUDY_LONG_TEXT(name) STUDY_TEXT(name)
#define STUDY_INTEGER(name) (void)sqlite3_bind_int64(statement, parameter++, study->name);
#include "study_columns.def"
#undef STUDY_TEXT
#undef STUDY_LONG_TEXT
#undef STUDY_INTEGER
}

enum talus_status study_row_insert(sqlite3 *database, const struct study *study,
                                   struct talus_error *error)
{
    struct text sql = {0};
    text_print(&sql, "%s%s", insert_begin, insert_values);
    if (sql.failed)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
    sqlite3_stmt *statement = store_prepare(database, sql.data, error);
    if (statement != NULL)
        row_bind(statement, study);
    text_release(&sql);
    return store_finish(database, statement, error);
}

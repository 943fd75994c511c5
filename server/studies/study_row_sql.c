/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_row_sql.h"

#define STUDY_TEXT(name) ", " #name
#define STUDY_INTEGER(name) STUDY_TEXT(name)
#define STUDY_LONG_TEXT(name) STUDY_TEXT(name)
#define ROW_STATE(ENUM, name) ", " #name
const char study_select_whole[] = "SELECT id"
#include "row_states.def"
#include "study_columns.def"
                                  " FROM studies";
#undef STUDY_LONG_TEXT
#undef ROW_STATE
#define STUDY_LONG_TEXT(name) ", NULL"
#define ROW_STATE(ENUM, name) ", " #name
const char study_select_light[] = "SELECT id"
#include "row_states.def"
#include "study_columns.def"
                                  " FROM studies";
#undef STUDY_LONG_TEXT
#undef ROW_STATE
#define STUDY_LONG_TEXT(name) STUDY_TEXT(name)
static const char insert_sql[] = "INSERT INTO studies (id"
#include "study_columns.def"
                                 ") VALUES (?"
#undef STUDY_TEXT
#define STUDY_TEXT(name) ", ?"
#include "study_columns.def"
                                 ")";
#undef STUDY_TEXT
#undef STUDY_INTEGER
#undef STUDY_LONG_TEXT

void study_row_read(sqlite3_stmt *statement, struct study *study)
{
    int column = 0;
    study->id = store_column_copy(statement, column++);
    for (size_t state = 0; state < ROW_STATE_COUNT; state++)
        study->counts[state] = sqlite3_column_int64(statement, column++);
#define STUDY_TEXT(name) study->name = store_column_copy(statement, column++);
#define STUDY_LONG_TEXT(name) study->name = store_column_copy(statement, column++);
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
    sqlite3_stmt *statement = store_prepare(database, insert_sql, error);
    if (statement != NULL)
        row_bind(statement, study);
    return store_finish(database, statement, error);
}

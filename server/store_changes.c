/* SPDX-License-Identifier: Apache-2.0 */
/* The transitions of jobs and studies in the order in which they happened. */
#include "store.h"
#include "store_internal.h"

static const char changes_sql[] =
    "SELECT * FROM ("
    "SELECT row, 0, job, at, state, attempt, reason, detail FROM transitions"
    " WHERE row > ?1 ORDER BY row LIMIT ?2) UNION ALL SELECT * FROM ("
    "SELECT row, 1, study, at, state, 0, NULL, detail FROM study_transitions"
    " WHERE row > ?1 AND number = -1 ORDER BY row LIMIT ?2) ORDER BY 1 LIMIT ?2";

static struct store_change change_of(sqlite3_stmt *statement)
{
    return (struct store_change){
        .row = sqlite3_column_int64(statement, 0),
        .study = sqlite3_column_int(statement, 1) != 0,
        .id = (const char *)sqlite3_column_text(statement, 2),
        .at = (const char *)sqlite3_column_text(statement, 3),
        .state = (const char *)sqlite3_column_text(statement, 4),
        .attempt = sqlite3_column_int64(statement, 5),
        .reason = (const char *)sqlite3_column_text(statement, 6),
        .detail = (const char *)sqlite3_column_text(statement, 7),
    };
}

enum talus_status store_changes(struct store *store, int64_t after, int64_t limit,
                                bool (*visit)(const struct store_change *change, void *context),
                                void *context, struct talus_error *error)
{
    enum talus_status status = TALUS_IO;
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement = store_prepare(store->reader, changes_sql, error);
    if (statement != NULL) {
        int step = SQLITE_ROW;
        bool more = true;
        (void)sqlite3_bind_int64(statement, 1, after);
        (void)sqlite3_bind_int64(statement, 2, limit);
        while (more && (step = sqlite3_step(statement)) == SQLITE_ROW) {
            const struct store_change change = change_of(statement);
            more = visit(&change, context);
        }
        status = step == SQLITE_ROW || step == SQLITE_DONE ? TALUS_OK
                                                           : store_failure(store->reader, error);
        (void)sqlite3_finalize(statement);
    }
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

enum talus_status store_changes_last(struct store *store, int64_t *row, struct talus_error *error)
{
    /* Both tables share their numbers, and those of deleted rows stay taken. */
    static const char sql[] =
        "SELECT coalesce((SELECT seq FROM sqlite_sequence WHERE name = 'transitions'), 0)";
    enum talus_status status = TALUS_IO;
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement = store_prepare(store->reader, sql, error);
    if (statement != NULL) {
        status =
            sqlite3_step(statement) == SQLITE_ROW ? TALUS_OK : store_failure(store->reader, error);
        if (status == TALUS_OK)
            *row = sqlite3_column_int64(statement, 0);
        (void)sqlite3_finalize(statement);
    }
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

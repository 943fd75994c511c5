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

struct change_visitor {
    bool (*visit)(const struct store_change *change, void *context);
    void *context;
};

static bool change_visit(sqlite3_stmt *statement, void *context)
{
    const struct change_visitor *visitor = context;
    const struct store_change change = {
        .row = sqlite3_column_int64(statement, 0),
        .study = sqlite3_column_int(statement, 1) != 0,
        .id = (const char *)sqlite3_column_text(statement, 2),
        .at = (const char *)sqlite3_column_text(statement, 3),
        .state = (const char *)sqlite3_column_text(statement, 4),
        .attempt = sqlite3_column_int64(statement, 5),
        .reason = (const char *)sqlite3_column_text(statement, 6),
        .detail = (const char *)sqlite3_column_text(statement, 7),
    };
    return visitor->visit(&change, visitor->context);
}

enum talus_status store_changes(struct store *store, int64_t after, int64_t limit,
                                bool (*visit)(const struct store_change *change, void *context),
                                void *context, struct talus_error *error)
{
    struct change_visitor visitor = {.visit = visit, .context = context};
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement = store_prepare(store->reader, changes_sql, error);
    if (statement != NULL) {
        (void)sqlite3_bind_int64(statement, 1, after);
        (void)sqlite3_bind_int64(statement, 2, limit);
    }
    enum talus_status status = store_visit(store->reader, statement, change_visit, &visitor, error);
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
        store_release(statement);
    }
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

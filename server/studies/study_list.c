/* SPDX-License-Identifier: Apache-2.0 */
/* Lists of studies, of their rows and of what happened to them. */
#include "store_internal.h"
#include "studies/study_row_sql.h"
#include "studies/study_store.h"

#include <string.h>

struct study_visitor {
    bool (*visit)(const struct study *study, void *context);
    void *context;
};

static bool study_visit(sqlite3_stmt *statement, void *context)
{
    const struct study_visitor *visitor = context;
    struct study study = {0};
    study_row_read(statement, &study);
    bool more = visitor->visit(&study, visitor->context);
    study_release(&study);
    return more;
}

enum talus_status study_store_list(struct store *store, const struct study_filter *filter,
                                   bool (*visit)(const struct study *study, void *context),
                                   void *context, struct talus_error *error)
{
    struct study_visitor visitor = {.visit = visit, .context = context};
    struct text sql = {0};
    text_print(&sql,
               "%s WHERE deleting = ?1 AND (?2 < 0 OR state = ?2) AND (?3 IS NULL OR id < ?3)"
               " ORDER BY id DESC LIMIT ?4",
               study_select_light);
    if (sql.failed)
        return talus_error_memory(error);
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement = store_prepare(store->reader, sql.data, error);
    if (statement != NULL) {
        int state = filter->state == STUDY_STATE_COUNT ? -1 : (int)filter->state;
        (void)sqlite3_bind_int(statement, 1, (int)filter->deleting);
        (void)sqlite3_bind_int(statement, 2, state);
        (void)sqlite3_bind_text(statement, 3, filter->before, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 4, filter->limit > 0 ? filter->limit : -1);
    }
    enum talus_status status = store_visit(store->reader, statement, study_visit, &visitor, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    text_release(&sql);
    return status;
}

struct row_visitor {
    bool (*visit)(const struct study_row *row, void *context);
    void *context;
};

static const char *text_at(sqlite3_stmt *statement, int column)
{
    return (const char *)sqlite3_column_text(statement, column);
}

static bool row_visit(sqlite3_stmt *statement, void *context)
{
    const struct row_visitor *visitor = context;
    const struct study_row row = {.number = sqlite3_column_int64(statement, 0),
                                  .state = (enum row_state)sqlite3_column_int(statement, 1),
                                  .reused = sqlite3_column_int(statement, 2) != 0,
                                  .parameters = text_at(statement, 3),
                                  .settings = text_at(statement, 4),
                                  .job = text_at(statement, 5),
                                  .reason = text_at(statement, 6),
                                  .detail = text_at(statement, 7),
                                  .metrics = text_at(statement, 8)};
    return visitor->visit(&row, visitor->context);
}

enum talus_status study_store_rows(struct store *store, const char *id,
                                   const struct row_filter *filter,
                                   bool (*visit)(const struct study_row *row, void *context),
                                   void *context, struct talus_error *error)
{
    static const char columns[] = "SELECT number, state, reused, parameters, settings,"
                                  " (SELECT id FROM jobs WHERE id = job AND deleting = 0),"
                                  " reason, detail, metrics FROM study_rows WHERE study = ?1";
    struct row_visitor visitor = {.visit = visit, .context = context};
    struct text sql = {0};
    text_print(&sql, "%s%s AND number >= ?3 ORDER BY number LIMIT ?4", columns,
               filter->state == ROW_STATE_COUNT ? "" : " AND state = ?2");
    if (sql.failed)
        return talus_error_memory(error);
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement = store_prepare(store->reader, sql.data, error);
    if (statement != NULL) {
        (void)sqlite3_bind_text(statement, 1, id, -1, SQLITE_STATIC);
        if (filter->state != ROW_STATE_COUNT)
            (void)sqlite3_bind_int(statement, 2, (int)filter->state);
        (void)sqlite3_bind_int64(statement, 3, filter->from);
        (void)sqlite3_bind_int64(statement, 4, filter->limit > 0 ? filter->limit : -1);
    }
    enum talus_status status = store_visit(store->reader, statement, row_visit, &visitor, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    text_release(&sql);
    return status;
}

static bool row_job_note(const struct study_row *row, void *context)
{
    return row->job == NULL || json_array_append_new(context, json_string(row->job)) == 0;
}

enum talus_status study_store_row_jobs(struct store *store, const char *id, enum row_state state,
                                       json_t *ids, struct talus_error *error)
{
    const struct row_filter filter = {.state = state};
    return study_store_rows(store, id, &filter, row_job_note, ids, error);
}

struct transition_visitor {
    bool (*visit)(const struct study_transition *transition, void *context);
    void *context;
};

static bool transition_visit(sqlite3_stmt *statement, void *context)
{
    const struct transition_visitor *visitor = context;
    const struct study_transition transition = {.row = sqlite3_column_int64(statement, 0),
                                                .number = sqlite3_column_int64(statement, 1),
                                                .at = text_at(statement, 2),
                                                .state = text_at(statement, 3),
                                                .job = text_at(statement, 4),
                                                .detail = text_at(statement, 5)};
    return visitor->visit(&transition, visitor->context);
}

enum talus_status study_store_transitions(struct store *store, const char *id, int64_t after,
                                          bool (*visit)(const struct study_transition *transition,
                                                        void *context),
                                          void *context, struct talus_error *error)
{
    struct transition_visitor visitor = {.visit = visit, .context = context};
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement =
        store_prepare(store->reader,
                      "SELECT row, number, at, state, job, detail FROM study_transitions"
                      " WHERE study = ?1 AND row > ?2 ORDER BY row",
                      error);
    if (statement != NULL) {
        (void)sqlite3_bind_text(statement, 1, id, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 2, after);
    }
    enum talus_status status =
        store_visit(store->reader, statement, transition_visit, &visitor, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

struct changes_visitor {
    int64_t after;
    bool (*visit)(const char *id, void *context);
    void *context;
};

static bool changes_visit(sqlite3_stmt *statement, void *context)
{
    struct changes_visitor *visitor = context;
    int64_t last = sqlite3_column_int64(statement, 1);
    if (last > visitor->after)
        visitor->after = last;
    return visitor->visit(text_at(statement, 0), visitor->context);
}

enum talus_status study_store_changes(struct store *store, int64_t *after,
                                      bool (*visit)(const char *id, void *context), void *context,
                                      struct talus_error *error)
{
    struct changes_visitor visitor = {.after = *after, .visit = visit, .context = context};
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement = store_prepare(
        store->reader,
        "SELECT study, max(row) FROM study_transitions WHERE row > ?1 GROUP BY study", error);
    if (statement != NULL)
        (void)sqlite3_bind_int64(statement, 1, *after);
    enum talus_status status =
        store_visit(store->reader, statement, changes_visit, &visitor, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    *after = visitor.after;
    return status;
}

static bool job_visit(sqlite3_stmt *statement, void *context)
{
    json_t *ids = context;
    return json_array_append_new(ids, json_string(text_at(statement, 0))) == 0;
}

enum talus_status study_store_jobs(struct store *store, const char *id, json_t **ids,
                                   struct talus_error *error)
{
    *ids = json_array();
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement =
        store_prepare(store->reader, "SELECT id FROM jobs WHERE study = ?1", error);
    if (statement != NULL)
        (void)sqlite3_bind_text(statement, 1, id, -1, SQLITE_STATIC);
    enum talus_status status = store_visit(store->reader, statement, job_visit, *ids, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

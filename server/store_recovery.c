/* SPDX-License-Identifier: Apache-2.0 */
#include "store_recovery.h"

#include "store_internal.h"

struct visitor {
    store_recovery_visit *visit;
    void *context;
};

static bool row_visit(sqlite3_stmt *statement, void *context)
{
    const struct visitor *visitor = context;
    visitor->visit((const char *)sqlite3_column_text(statement, 0),
                   sqlite3_column_int64(statement, 1), visitor->context);
    return true;
}

/* Visits rows of an identifier and a number. */
static enum talus_status rows_visit(struct store *store, const char *sql,
                                    store_recovery_visit *visit, void *context,
                                    struct talus_error *error)
{
    struct visitor visitor = {visit, context};
    (void)pthread_mutex_lock(&store->reader_mutex);
    enum talus_status status = store_visit(store->reader, store_prepare(store->reader, sql, error),
                                           row_visit, &visitor, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

enum talus_status store_recovery_jobs(struct store *store, store_recovery_visit *visit,
                                      void *context, struct talus_error *error)
{
    return rows_visit(store, "SELECT id, state FROM jobs INDEXED BY jobs_by_state_newest", visit,
                      context, error);
}

enum talus_status store_recovery_removals(struct store *store, store_recovery_visit *visit,
                                          void *context, struct talus_error *error)
{
    return rows_visit(store, "SELECT id, 0 FROM jobs INDEXED BY jobs_deleting WHERE deleting <> 0",
                      visit, context, error);
}

enum talus_status store_recovery_untold(struct store *store, store_recovery_visit *visit,
                                        void *context, struct talus_error *error)
{
    _Static_assert(JOB_RUNNING == 1, "the number is in the statement");
    return rows_visit(store,
                      "SELECT job, max(number) FROM transitions"
                      " WHERE row > coalesce((SELECT row FROM told), 0) AND NOT EXISTS"
                      " (SELECT 1 FROM jobs WHERE id = job AND (state = 1 OR deleting <> 0))"
                      " GROUP BY job",
                      visit, context, error);
}

static enum talus_status mark_apply(sqlite3 *database, void *context, struct talus_error *error)
{
    (void)context;
    return store_finish(database,
                        store_prepare(database,
                                      "INSERT INTO told (id, row)"
                                      " SELECT 1, coalesce(max(row), 0) FROM transitions WHERE true"
                                      " ON CONFLICT (id) DO UPDATE SET row = excluded.row",
                                      error),
                        error);
}

enum talus_status store_recovery_mark(struct store *store, struct talus_error *error)
{
    return store_write(store, mark_apply, NULL, error);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "store.h"

#include "store_internal.h"
#include "text.h"

#include <stdlib.h>
#include <string.h>

enum talus_status store_failure(sqlite3 *database, struct talus_error *error)
{
    return talus_error_set(error, TALUS_IO, "store", "", "the store failed: %s",
                           sqlite3_errmsg(database));
}

/* Before the text of every statement that is kept: virtual tables keep statements of their own. */
static const char mark[] = "/* kept */ ";

static bool statement_kept(sqlite3_stmt *statement)
{
    return strncmp(sqlite3_sql(statement), mark, sizeof mark - 1) == 0;
}

sqlite3_stmt *store_prepare(sqlite3 *database, const char *sql, struct talus_error *error)
{
    sqlite3_stmt *statement = NULL;
    while ((statement = sqlite3_next_stmt(database, statement)) != NULL) {
        if (statement_kept(statement) && sqlite3_stmt_busy(statement) == 0 &&
            strcmp(sqlite3_sql(statement) + sizeof mark - 1, sql) == 0)
            return statement;
    }
    struct text marked = {0};
    text_print(&marked, "%s%s", mark, sql);
    if (marked.failed)
        (void)talus_error_memory(error);
    else if (sqlite3_prepare_v3(database, marked.data, -1, SQLITE_PREPARE_PERSISTENT, &statement,
                                NULL) != SQLITE_OK)
        store_failure(database, error);
    text_release(&marked);
    return statement;
}

void store_release(sqlite3_stmt *statement)
{
    (void)sqlite3_reset(statement);
    (void)sqlite3_clear_bindings(statement);
}

enum talus_status store_finish(sqlite3 *database, sqlite3_stmt *statement,
                               struct talus_error *error)
{
    if (statement == NULL)
        return TALUS_IO;
    int step = sqlite3_step(statement);
    enum talus_status status =
        step == SQLITE_DONE || step == SQLITE_ROW ? TALUS_OK : store_failure(database, error);
    store_release(statement);
    return status;
}

enum talus_status store_visit(sqlite3 *database, sqlite3_stmt *statement,
                              bool (*visit)(sqlite3_stmt *statement, void *context), void *context,
                              struct talus_error *error)
{
    if (statement == NULL)
        return TALUS_IO;
    int step = SQLITE_DONE;
    bool more = true;
    while (more && (step = sqlite3_step(statement)) == SQLITE_ROW)
        more = visit(statement, context);
    enum talus_status status =
        step == SQLITE_ROW || step == SQLITE_DONE ? TALUS_OK : store_failure(database, error);
    store_release(statement);
    return status;
}

char *store_column_copy(sqlite3_stmt *statement, int column)
{
    const char *value = (const char *)sqlite3_column_text(statement, column);
    return value == NULL ? NULL : strdup(value);
}

enum talus_status store_run_for(sqlite3 *database, const char *sql, const char *id,
                                struct talus_error *error)
{
    sqlite3_stmt *statement = store_prepare(database, sql, error);
    if (statement != NULL)
        (void)sqlite3_bind_text(statement, 1, id, -1, SQLITE_STATIC);
    return store_finish(database, statement, error);
}

bool store_execute(sqlite3 *database, const char *sql)
{
    return sqlite3_exec(database, sql, NULL, NULL, NULL) == SQLITE_OK;
}

/* Applies a chain of writes in one transaction; each stands or falls alone unless the commit
 * fails. */
static bool writes_commit(sqlite3 *database, struct store_write *first)
{
    bool begun = store_execute(database, "BEGIN IMMEDIATE");
    for (struct store_write *write = first; write != NULL && begun; write = write->next) {
        if (!store_execute(database, "SAVEPOINT one")) {
            write->status = store_failure(database, write->error);
            continue;
        }
        write->status = write->apply(database, write->context, write->error);
        if (write->status != TALUS_OK && !store_execute(database, "ROLLBACK TO one"))
            begun = false;
        if (!store_execute(database, "RELEASE one"))
            begun = false;
    }
    if (begun && store_execute(database, "COMMIT"))
        return true;
    for (struct store_write *write = first; write != NULL; write = write->next) {
        if (write->status == TALUS_OK)
            write->status = store_failure(database, write->error);
    }
    if (sqlite3_get_autocommit(database) == 0)
        (void)store_execute(database, "ROLLBACK");
    return false;
}

static void *writer_main(void *argument)
{
    struct store *store = argument;
    (void)pthread_mutex_lock(&store->mutex);
    for (;;) {
        while (store->first == NULL && !store->stopping)
            (void)pthread_cond_wait(&store->queued, &store->mutex);
        struct store_write *first = store->first;
        if (first == NULL)
            break;
        store->first = store->last = NULL;
        (void)pthread_mutex_unlock(&store->mutex);
        bool good = writes_commit(store->writer, first);
        atomic_fetch_add(&store->commit_count, 1);
        (void)pthread_mutex_lock(&store->mutex);
        store->broken = !good;
        while (first != NULL) {
            struct store_write *next = first->next;
            first->done = true;
            first = next;
        }
        (void)pthread_cond_broadcast(&store->committed);
    }
    (void)pthread_mutex_unlock(&store->mutex);
    return NULL;
}

enum talus_status store_write(struct store *store, store_apply *apply, void *context,
                              struct talus_error *error)
{
    struct store_write write = {.apply = apply, .context = context, .error = error};
    (void)pthread_mutex_lock(&store->mutex);
    if (store->last == NULL)
        store->first = &write;
    else
        store->last->next = &write;
    store->last = &write;
    (void)pthread_cond_signal(&store->queued);
    while (!write.done)
        (void)pthread_cond_wait(&store->committed, &store->mutex);
    (void)pthread_mutex_unlock(&store->mutex);
    return write.status;
}

uint64_t store_commit_count(const struct store *store)
{
    return atomic_load(&store->commit_count);
}

bool store_healthy(struct store *store)
{
    (void)pthread_mutex_lock(&store->mutex);
    bool healthy = !store->broken;
    (void)pthread_mutex_unlock(&store->mutex);
    return healthy;
}

static bool connection_open(const char *path, sqlite3 **database)
{
    return sqlite3_open_v2(path, database,
                           SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX,
                           NULL) == SQLITE_OK &&
           sqlite3_busy_timeout(*database, 10000) == SQLITE_OK &&
           store_execute(*database, "PRAGMA journal_mode = WAL") &&
           store_execute(*database, "PRAGMA synchronous = FULL") &&
           store_execute(*database, "PRAGMA foreign_keys = ON");
}

/* Lists read rows from all over: [KiB] of pages that are kept between them. */
static bool reader_open(const char *path, sqlite3 **database)
{
    return connection_open(path, database) &&
           store_execute(*database, "PRAGMA cache_size = -16384");
}

static void connection_close(sqlite3 *database)
{
    sqlite3_stmt *next = database == NULL ? NULL : sqlite3_next_stmt(database, NULL);
    while (next != NULL) {
        sqlite3_stmt *statement = next;
        next = sqlite3_next_stmt(database, statement);
        if (statement_kept(statement))
            (void)sqlite3_finalize(statement);
    }
    (void)sqlite3_close(database);
}

enum talus_status store_open(const char *path, struct store **result, struct talus_error *error)
{
    struct store *store = calloc(1, sizeof *store);
    if (store == NULL)
        return talus_error_memory(error);
    (void)pthread_mutex_init(&store->mutex, NULL);
    (void)pthread_mutex_init(&store->reader_mutex, NULL);
    (void)pthread_cond_init(&store->queued, NULL);
    (void)pthread_cond_init(&store->committed, NULL);
    enum talus_status status = TALUS_OK;
    if (!connection_open(path, &store->writer))
        status = store_failure(store->writer, error);
    if (status == TALUS_OK)
        status = store_schema_prepare(store->writer, error);
    if (status == TALUS_OK && !reader_open(path, &store->reader))
        status = store_failure(store->reader, error);
    if (status == TALUS_OK) {
        store->started = pthread_create(&store->thread, NULL, writer_main, store) == 0;
        if (!store->started)
            status = talus_error_set(error, TALUS_INTERNAL, "thread", "", "cannot start a thread");
    }
    if (status != TALUS_OK) {
        store_close(store);
        store = NULL;
    }
    *result = store;
    return status;
}

void store_close(struct store *store)
{
    if (store == NULL)
        return;
    (void)pthread_mutex_lock(&store->mutex);
    store->stopping = true;
    (void)pthread_cond_signal(&store->queued);
    (void)pthread_mutex_unlock(&store->mutex);
    if (store->started)
        (void)pthread_join(store->thread, NULL);
    connection_close(store->reader);
    connection_close(store->writer);
    (void)pthread_cond_destroy(&store->queued);
    (void)pthread_cond_destroy(&store->committed);
    (void)pthread_mutex_destroy(&store->mutex);
    (void)pthread_mutex_destroy(&store->reader_mutex);
    free(store);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_store.h"

#include "moment.h"
#include "store_internal.h"
#include "studies/study_row_sql.h"
#include "studies/study_rows.h"

#include <stdlib.h>
#include <string.h>

static enum talus_status not_found(const char *id, struct talus_error *error)
{
    return talus_error_set(error, TALUS_INVALID, "not_found", "", "there is no study %s", id);
}

/* Reads any study, also one that is being deleted. */
static enum talus_status study_find(sqlite3 *database, const char *id, bool whole,
                                    struct study *study, struct talus_error *error)
{
    struct text sql = {0};
    text_print(&sql, "%s WHERE id = ?", whole ? study_select_whole : study_select_light);
    if (sql.failed)
        return talus_error_memory(error);
    sqlite3_stmt *statement = store_prepare(database, sql.data, error);
    text_release(&sql);
    if (statement == NULL)
        return TALUS_IO;
    (void)sqlite3_bind_text(statement, 1, id, -1, SQLITE_STATIC);
    int step = sqlite3_step(statement);
    enum talus_status status = TALUS_OK;
    if (step == SQLITE_ROW)
        study_row_read(statement, study);
    else
        status = step == SQLITE_DONE ? not_found(id, error) : store_failure(database, error);
    store_release(statement);
    return status;
}

enum talus_status study_store_read(struct store *store, const char *id, bool whole,
                                   struct study *study, struct talus_error *error)
{
    (void)pthread_mutex_lock(&store->reader_mutex);
    enum talus_status status = study_find(store->reader, id, whole, study, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    if (status == TALUS_OK && study->deleting) {
        study_release(study);
        status = not_found(id, error);
    }
    return status;
}

struct insert_context {
    const struct study *study;
    const json_t *rows;
    const struct store_key *key;
    enum store_insert result;
    char existing[64];
};

static enum talus_status state_write(sqlite3 *database, const struct study *study, const char *at,
                                     struct talus_error *error)
{
    const struct study_transition transition = {
        .number = -1,
        .at = at,
        .state = study_state_name((enum study_state)study->state),
        .detail = study->detail};
    return study_transition_write(database, study->id, &transition, error);
}

static enum talus_status insert_apply(sqlite3 *database, void *context, struct talus_error *error)
{
    struct insert_context *insert = context;
    const struct study *study = insert->study;
    enum talus_status status = TALUS_OK;
    insert->result = STORE_INSERTED;
    if (insert->key != NULL)
        status = store_key_look(database, insert->key, &insert->result, insert->existing, error);
    if (status != TALUS_OK || insert->result != STORE_INSERTED)
        return status;
    status = study_row_insert(database, study, error);
    if (status == TALUS_OK)
        status = study_rows_append(database, study->id, 0, insert->rows, error);
    if (status == TALUS_OK)
        status = state_write(database, study, study->created_at, error);
    if (status == TALUS_OK && insert->key != NULL)
        status = store_key_write(database, insert->key, study->id, error);
    return status;
}

enum talus_status study_store_insert(struct store *store, const struct study *study,
                                     const json_t *rows, const struct store_key *key,
                                     enum store_insert *result, char existing[64],
                                     struct talus_error *error)
{
    struct insert_context insert = {.study = study, .rows = rows, .key = key};
    enum talus_status status = store_write(store, insert_apply, &insert, error);
    memcpy(existing, insert.existing, sizeof insert.existing);
    *result = insert.result;
    return status;
}

struct change_context {
    const char *id;
    struct study_change *change;
    struct study study;
};

static enum talus_status change_write(sqlite3 *database, const struct study *study,
                                      struct talus_error *error)
{
    sqlite3_stmt *statement =
        store_prepare(database,
                      "UPDATE studies SET state = ?, detail = ?, cancel_requested = ?,"
                      " deleting = ?, finished_at = ?, result = ?, rows_expected = ?,"
                      " revision = revision + 1 WHERE id = ?",
                      error);
    if (statement != NULL) {
        (void)sqlite3_bind_int64(statement, 1, study->state);
        (void)sqlite3_bind_text(statement, 2, study->detail, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 3, study->cancel_requested);
        (void)sqlite3_bind_int64(statement, 4, study->deleting);
        (void)sqlite3_bind_text(statement, 5, study->finished_at, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 6, study->result, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 7, study->rows_expected);
        (void)sqlite3_bind_text(statement, 8, study->id, -1, SQLITE_STATIC);
    }
    return store_finish(database, statement, error);
}

/* Rows that come later are told, unlike those that a study begins with. */
static enum talus_status rows_add(sqlite3 *database, const struct study *study, const json_t *rows,
                                  const char *at, struct talus_error *error)
{
    enum talus_status status =
        study_rows_append(database, study->id, study->row_count, rows, error);
    for (size_t index = 0; index < json_array_size(rows) && status == TALUS_OK; index++) {
        const struct study_transition transition = {.number = study->row_count + (int64_t)index,
                                                    .at = at,
                                                    .state = row_state_name(ROW_WAITING)};
        status = study_transition_write(database, study->id, &transition, error);
    }
    return status;
}

static enum talus_status change_apply(sqlite3 *database, void *context, struct talus_error *error)
{
    struct change_context *all = context;
    struct study_change *change = all->change;
    struct study *study = &all->study;
    char now[MOMENT_TEXT_SIZE];
    moment_now_text(now);
    enum talus_status status = study_find(database, all->id, false, study, error);
    if (status == TALUS_OK && study->deleting)
        status = not_found(all->id, error);
    int64_t state = study->state;
    if (status == TALUS_OK)
        status = change->apply(study, change, error);
    if (status == TALUS_OK)
        status = change_write(database, study, error);
    if (status == TALUS_OK && change->rows != NULL)
        status = rows_add(database, study, change->rows, now, error);
    if (status == TALUS_OK && change->cancel_waiting)
        status = study_rows_cancel(database, study->id, now, error);
    if (status == TALUS_OK && study->state != state)
        status = state_write(database, study, now, error);
    if (status == TALUS_OK && study->deleting)
        status = store_keys_remove(database, study->id, error);
    if (status == TALUS_OK && study->deleting)
        status = store_run_for(database, "UPDATE jobs SET deleting = 1 WHERE study = ?", study->id,
                               error);
    if (status != TALUS_OK)
        return status;
    study_release(study);
    return study_find(database, all->id, false, study, error);
}

enum talus_status study_store_change(struct store *store, const char *id,
                                     struct study_change *change, struct study *result,
                                     struct talus_error *error)
{
    struct change_context all = {.id = id, .change = change};
    enum talus_status status = store_write(store, change_apply, &all, error);
    if (status == TALUS_OK && result != NULL)
        *result = all.study;
    else
        study_release(&all.study);
    return status;
}

static enum talus_status row_end_apply(sqlite3 *database, void *context, struct talus_error *error)
{
    return study_row_end(database, context, error);
}

enum talus_status study_store_row_end(struct store *store, const struct row_end *end,
                                      struct talus_error *error)
{
    struct row_end copy = *end;
    return store_write(store, row_end_apply, &copy, error);
}

enum talus_status study_store_remove(struct store *store, const char *id, struct talus_error *error)
{
    return store_remove(store, "DELETE FROM studies WHERE id = ?", id, error);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* The rows of jobs, their keys and their transitions. */
#include "store.h"
#include "store_internal.h"
#include "store_row.h"
#include "studies/study_rows.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static enum talus_status transition_write(sqlite3 *database, const struct job *job,
                                          struct talus_error *error)
{
    sqlite3_stmt *statement =
        store_prepare(database,
                      "INSERT INTO transitions (job, number, at, state, attempt, reason, detail)"
                      " VALUES (?, ?, ?, ?, ?, ?, ?)",
                      error);
    if (statement != NULL) {
        const char *state = job_state_name((enum job_state)job->state);
        (void)sqlite3_bind_text(statement, 1, job->id, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 2, job->transition_count);
        (void)sqlite3_bind_text(statement, 3, job->changed_at, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 4, state, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 5, job->attempt);
        (void)sqlite3_bind_text(statement, 6, job->reason, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 7, job->detail, -1, SQLITE_STATIC);
    }
    return store_finish(database, statement, error);
}

static enum talus_status not_found(const char *id, struct talus_error *error)
{
    return talus_error_set(error, TALUS_INVALID, "not_found", "", "there is no job %s", id);
}

static enum talus_status row_find(sqlite3 *database, const char *id, struct job *job,
                                  struct talus_error *error)
{
    char sql[2048];
    (void)snprintf(sql, sizeof sql, "%s FROM jobs WHERE id = ?", store_row_select);
    sqlite3_stmt *statement = store_prepare(database, sql, error);
    if (statement == NULL)
        return TALUS_IO;
    (void)sqlite3_bind_text(statement, 1, id, -1, SQLITE_STATIC);
    int step = sqlite3_step(statement);
    enum talus_status status = TALUS_OK;
    if (step == SQLITE_ROW)
        store_row_read(statement, job);
    else if (step == SQLITE_DONE)
        status = not_found(id, error);
    else
        status = store_failure(database, error);
    store_release(statement);
    return status;
}

enum talus_status store_job_read(struct store *store, const char *id, struct job *job,
                                 struct talus_error *error)
{
    (void)pthread_mutex_lock(&store->reader_mutex);
    enum talus_status status = row_find(store->reader, id, job, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    if (status == TALUS_OK && job->deleting) {
        job_release(job);
        status = not_found(id, error);
    }
    return status;
}

enum talus_status store_key_look(sqlite3 *database, const struct store_key *key,
                                 enum store_insert *result, char existing[64],
                                 struct talus_error *error)
{
    *result = STORE_INSERTED;
    sqlite3_stmt *statement = store_prepare(
        database, "SELECT body, resource FROM request_keys WHERE owner = ? AND key = ?", error);
    if (statement == NULL)
        return TALUS_IO;
    (void)sqlite3_bind_text(statement, 1, key->owner, -1, SQLITE_STATIC);
    (void)sqlite3_bind_text(statement, 2, key->key, -1, SQLITE_STATIC);
    int step = sqlite3_step(statement);
    if (step == SQLITE_ROW) {
        const char *body = (const char *)sqlite3_column_text(statement, 0);
        const char *resource = (const char *)sqlite3_column_text(statement, 1);
        *result = strcmp(body, key->body) == 0 ? STORE_REPLAYED : STORE_OTHER_BODY;
        (void)snprintf(existing, 64, "%s", resource);
    }
    store_release(statement);
    return step == SQLITE_ROW || step == SQLITE_DONE ? TALUS_OK : store_failure(database, error);
}

enum talus_status store_key_find(struct store *store, const struct store_key *key,
                                 enum store_insert *result, char existing[64],
                                 struct talus_error *error)
{
    (void)pthread_mutex_lock(&store->reader_mutex);
    enum talus_status status = store_key_look(store->reader, key, result, existing, error);
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

enum talus_status store_keys_remove(sqlite3 *database, const char *resource,
                                    struct talus_error *error)
{
    return store_run_for(database, "DELETE FROM request_keys WHERE resource = ?", resource, error);
}

struct insert_context {
    const struct job *job;
    const struct store_key *key;
    struct store_limits limits;
    enum store_insert result;
    char existing[64];
};

/* Whether a figure of the queue stays below a bound; if not, the result says so. The figure is what
 * a statement with state and owner as parameters yields. */
static enum talus_status limit_check(sqlite3 *database, struct insert_context *insert,
                                     const char *sql, double more, double bound,
                                     enum store_insert result, struct talus_error *error)
{
    if (bound <= 0 || insert->result != STORE_INSERTED)
        return TALUS_OK;
    sqlite3_stmt *statement = store_prepare(database, sql, error);
    if (statement == NULL)
        return TALUS_IO;
    int owner = sqlite3_bind_parameter_index(statement, ":owner");
    if (owner > 0)
        (void)sqlite3_bind_text(statement, owner,
                                insert->job->owner == NULL ? "" : insert->job->owner, -1,
                                SQLITE_STATIC);
    bool found = sqlite3_step(statement) == SQLITE_ROW;
    if (found && sqlite3_column_double(statement, 0) + more > bound)
        insert->result = result;
    store_release(statement);
    return found ? TALUS_OK : store_failure(database, error);
}

static double forecast_disk(const struct job *job)
{
    json_t *forecast = json_loads(job->forecast == NULL ? "{}" : job->forecast, 0, NULL);
    double bytes = json_number_value(json_object_get(forecast, "disk_bytes"));
    json_decref(forecast);
    return bytes;
}

static enum talus_status limits_check(sqlite3 *database, struct insert_context *insert,
                                      struct talus_error *error)
{
    const struct store_limits *limits = &insert->limits;
    _Static_assert(JOB_QUEUED == 0 && JOB_STATE_COUNT == 5, "the numbers are in the statements");
    enum talus_status status =
        limit_check(database, insert, "SELECT count(*) FROM jobs WHERE state = 0", 1,
                    (double)limits->queued, STORE_QUEUE_FULL, error);
    if (status == TALUS_OK)
        status = limit_check(database, insert,
                             "SELECT count(*) FROM jobs WHERE state = 0 AND owner = :owner", 1,
                             (double)limits->owner_queued, STORE_QUOTA_QUEUED, error);
    if (status == TALUS_OK && limits->owner_disk > 0)
        status =
            limit_check(database, insert,
                        "SELECT coalesce(sum(json_extract(forecast, '$.disk_bytes')), 0)"
                        " FROM jobs WHERE state IN (0, 1, 2, 3, 4) AND owner = :owner",
                        forecast_disk(insert->job), limits->owner_disk, STORE_QUOTA_DISK, error);
    return status;
}

enum talus_status store_key_write(sqlite3 *database, const struct store_key *key,
                                  const char *resource, struct talus_error *error)
{
    sqlite3_stmt *statement = store_prepare(
        database, "INSERT INTO request_keys (key, owner, body, resource) VALUES (?, ?, ?, ?)",
        error);
    if (statement != NULL) {
        (void)sqlite3_bind_text(statement, 1, key->key, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 2, key->owner, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 3, key->body, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 4, resource, -1, SQLITE_STATIC);
    }
    return store_finish(database, statement, error);
}

static enum talus_status insert_apply(sqlite3 *database, void *context, struct talus_error *error)
{
    struct insert_context *insert = context;
    enum talus_status status = TALUS_OK;
    insert->result = STORE_INSERTED;
    if (insert->key != NULL)
        status = store_key_look(database, insert->key, &insert->result, insert->existing, error);
    if (status == TALUS_OK && insert->result == STORE_INSERTED)
        status = limits_check(database, insert, error);
    if (status != TALUS_OK || insert->result != STORE_INSERTED)
        return status;
    status = study_row_enter(database, insert->job, error);
    if (status == TALUS_OK)
        status = store_row_write(database, insert->job, error);
    if (status == TALUS_OK)
        status = transition_write(database, insert->job, error);
    if (status == TALUS_OK && insert->key != NULL)
        status = store_key_write(database, insert->key, insert->job->id, error);
    return status;
}

enum talus_status store_job_insert(struct store *store, const struct job *job,
                                   const struct store_key *key, const struct store_limits *limits,
                                   enum store_insert *result, char existing[64],
                                   struct talus_error *error)
{
    struct insert_context insert = {.job = job,
                                    .key = key,
                                    .limits = limits == NULL ? (struct store_limits){.queued = 0}
                                                             : *limits};
    enum talus_status status = store_write(store, insert_apply, &insert, error);
    memcpy(existing, insert.existing, sizeof insert.existing);
    *result = insert.result;
    return status;
}

struct change_context {
    const char *id;
    enum talus_status (*change)(struct job *job, void *context, struct talus_error *error);
    void *context;
    struct job job;
};

static enum talus_status change_apply(sqlite3 *database, void *context, struct talus_error *error)
{
    struct change_context *change = context;
    enum talus_status status = row_find(database, change->id, &change->job, error);
    if (status == TALUS_OK && change->job.deleting)
        status = not_found(change->id, error);
    if (status != TALUS_OK)
        return status;
    int64_t transition_count = change->job.transition_count;
    status = change->change(&change->job, change->context, error);
    if (status != TALUS_OK)
        return status;
    assert(change->job.transition_count <= transition_count + 1);
    change->job.revision++;
    status = store_row_write(database, &change->job, error);
    if (status == TALUS_OK && change->job.transition_count > transition_count)
        status = transition_write(database, &change->job, error);
    if (status == TALUS_OK && change->job.transition_count > transition_count)
        status = study_row_follow(database, &change->job, error);
    if (status == TALUS_OK && change->job.deleting)
        status = store_keys_remove(database, change->id, error);
    return status;
}

enum talus_status store_job_change(struct store *store, const char *id,
                                   enum talus_status (*change)(struct job *job, void *context,
                                                               struct talus_error *error),
                                   void *context, struct job *result, struct talus_error *error)
{
    struct change_context all = {.id = id, .change = change, .context = context};
    enum talus_status status = store_write(store, change_apply, &all, error);
    if (status == TALUS_OK && result != NULL)
        *result = all.job;
    else
        job_release(&all.job);
    return status;
}

struct removal {
    const char *id, *sql;
};

static enum talus_status remove_apply(sqlite3 *database, void *context, struct talus_error *error)
{
    const struct removal *removal = context;
    enum talus_status status = store_keys_remove(database, removal->id, error);
    return status == TALUS_OK ? store_run_for(database, removal->sql, removal->id, error) : status;
}

enum talus_status store_remove(struct store *store, const char *sql, const char *id,
                               struct talus_error *error)
{
    struct removal removal = {.id = id, .sql = sql};
    return store_write(store, remove_apply, &removal, error);
}

enum talus_status store_job_remove(struct store *store, const char *id, struct talus_error *error)
{
    return store_remove(store, "DELETE FROM jobs WHERE id = ?", id, error);
}

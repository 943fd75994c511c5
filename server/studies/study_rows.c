/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_rows.h"

#include "json_text.h"
#include "moment.h"
#include "text.h"

#include <stdlib.h>
#include <string.h>

/* Takes the next `count` numbers of the sequence that the transitions of jobs have. */
static enum talus_status numbers_take(sqlite3 *database, int64_t count, int64_t *first,
                                      struct talus_error *error)
{
    if (!store_execute(database, "INSERT INTO sqlite_sequence (name, seq) SELECT 'transitions', 0"
                                 " WHERE NOT EXISTS (SELECT 1 FROM sqlite_sequence"
                                 " WHERE name = 'transitions')"))
        return store_failure(database, error);
    sqlite3_stmt *statement = store_prepare(
        database, "SELECT seq FROM sqlite_sequence WHERE name = 'transitions'", error);
    if (statement == NULL)
        return TALUS_IO;
    bool found = sqlite3_step(statement) == SQLITE_ROW;
    *first = found ? sqlite3_column_int64(statement, 0) + 1 : 0;
    store_release(statement);
    if (!found)
        return store_failure(database, error);
    statement = store_prepare(
        database, "UPDATE sqlite_sequence SET seq = ? WHERE name = 'transitions'", error);
    if (statement != NULL)
        (void)sqlite3_bind_int64(statement, 1, *first + count - 1);
    return store_finish(database, statement, error);
}

enum talus_status study_transition_write(sqlite3 *database, const char *study,
                                         const struct study_transition *transition,
                                         struct talus_error *error)
{
    int64_t row = 0;
    enum talus_status status = numbers_take(database, 1, &row, error);
    if (status != TALUS_OK)
        return status;
    sqlite3_stmt *statement =
        store_prepare(database,
                      "INSERT INTO study_transitions (row, study, number, at, state, job, detail)"
                      " VALUES (?, ?, ?, ?, ?, ?, ?)",
                      error);
    if (statement != NULL) {
        (void)sqlite3_bind_int64(statement, 1, row);
        (void)sqlite3_bind_text(statement, 2, study, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 3, transition->number);
        (void)sqlite3_bind_text(statement, 4, transition->at, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 5, transition->state, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 6, transition->job, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 7, transition->detail, -1, SQLITE_STATIC);
    }
    return store_finish(database, statement, error);
}

/* Binds a member of a row as JSON text; false without memory. */
static bool member_bind(sqlite3_stmt *statement, int parameter, const json_t *row, const char *key)
{
    char *text = json_text(json_object_get(row, key), 0);
    return text != NULL && sqlite3_bind_text(statement, parameter, text, -1, free) == SQLITE_OK;
}

enum talus_status study_rows_append(sqlite3 *database, const char *study, int64_t count,
                                    const json_t *rows, struct talus_error *error)
{
    sqlite3_stmt *statement =
        store_prepare(database,
                      "INSERT INTO study_rows (study, number, state, parameters, settings)"
                      " VALUES (?, ?, ?, ?, ?)",
                      error);
    enum talus_status status = statement == NULL ? TALUS_IO : TALUS_OK;
    size_t index;
    const json_t *row;
    json_array_foreach(rows, index, row)
    {
        if (status != TALUS_OK)
            break;
        (void)sqlite3_bind_text(statement, 1, study, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 2, count + (int64_t)index);
        (void)sqlite3_bind_int(statement, 3, ROW_WAITING);
        if (!member_bind(statement, 4, row, "parameters") || !member_bind(statement, 5, row, "set"))
            status = talus_error_memory(error);
        else if (sqlite3_step(statement) != SQLITE_DONE)
            status = store_failure(database, error);
        store_release(statement);
    }
    store_release(statement);
    if (status != TALUS_OK)
        return status;
    statement = store_prepare(database,
                              "UPDATE studies SET row_count = row_count + ?1,"
                              " waiting = waiting + ?1 WHERE id = ?2",
                              error);
    if (statement != NULL) {
        (void)sqlite3_bind_int64(statement, 1, (int64_t)json_array_size(rows));
        (void)sqlite3_bind_text(statement, 2, study, -1, SQLITE_STATIC);
    }
    return store_finish(database, statement, error);
}

enum talus_status study_rows_cancel(sqlite3 *database, const char *study, const char *at,
                                    struct talus_error *error)
{
    int64_t first = 0, count = 0;
    sqlite3_stmt *statement =
        store_prepare(database, "SELECT waiting FROM studies WHERE id = ?", error);
    if (statement == NULL)
        return TALUS_IO;
    (void)sqlite3_bind_text(statement, 1, study, -1, SQLITE_STATIC);
    if (sqlite3_step(statement) == SQLITE_ROW)
        count = sqlite3_column_int64(statement, 0);
    store_release(statement);
    if (count == 0)
        return TALUS_OK;
    enum talus_status status = numbers_take(database, count, &first, error);
    if (status != TALUS_OK)
        return status;
    statement = store_prepare(database,
                              "INSERT INTO study_transitions (row, study, number, at, state)"
                              " SELECT ?1 - 1 + row_number() OVER (ORDER BY number), study, number,"
                              " ?2, ?3 FROM study_rows WHERE study = ?4 AND state = ?5",
                              error);
    if (statement != NULL) {
        (void)sqlite3_bind_int64(statement, 1, first);
        (void)sqlite3_bind_text(statement, 2, at, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 3, row_state_name(ROW_CANCELLED), -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 4, study, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int(statement, 5, ROW_WAITING);
    }
    status = store_finish(database, statement, error);
    if (status != TALUS_OK)
        return status;
    statement = store_prepare(
        database, "UPDATE study_rows SET state = ?1 WHERE study = ?2 AND state = ?3", error);
    if (statement != NULL) {
        (void)sqlite3_bind_int(statement, 1, ROW_CANCELLED);
        (void)sqlite3_bind_text(statement, 2, study, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int(statement, 3, ROW_WAITING);
    }
    status = store_finish(database, statement, error);
    return status == TALUS_OK
               ? store_run_for(database,
                               "UPDATE studies SET cancelled = cancelled + waiting, waiting = 0"
                               " WHERE id = ?",
                               study, error)
               : status;
}

/* Where a row stands; `state` is ROW_STATE_COUNT if there is no such row. */
struct row_place {
    enum row_state state;
    bool same_job; /* it shows this job */
    char *wanted;
};

static enum talus_status place_find(sqlite3 *database, const struct row_end *end,
                                    struct row_place *place, struct talus_error *error)
{
    place->state = ROW_STATE_COUNT;
    sqlite3_stmt *statement =
        store_prepare(database,
                      "SELECT study_rows.state, job IS ?1, wanted FROM study_rows"
                      " JOIN studies ON id = study WHERE study = ?2 AND number = ?3",
                      error);
    if (statement == NULL)
        return TALUS_IO;
    (void)sqlite3_bind_text(statement, 1, end->job, -1, SQLITE_STATIC);
    (void)sqlite3_bind_text(statement, 2, end->study, -1, SQLITE_STATIC);
    (void)sqlite3_bind_int64(statement, 3, end->number);
    int step = sqlite3_step(statement);
    if (step == SQLITE_ROW) {
        place->state = (enum row_state)sqlite3_column_int(statement, 0);
        place->same_job = sqlite3_column_int(statement, 1) != 0;
        place->wanted = store_column_copy(statement, 2);
    }
    store_release(statement);
    return step == SQLITE_ROW || step == SQLITE_DONE ? TALUS_OK : store_failure(database, error);
}

/* Runs a statement about a study, whose text is released. */
static enum talus_status study_run_text(sqlite3 *database, struct text *sql, const char *study,
                                        struct talus_error *error)
{
    enum talus_status status =
        sql->failed ? talus_error_memory(error) : store_run_for(database, sql->data, study, error);
    text_release(sql);
    return status;
}

static enum talus_status counts_move(sqlite3 *database, const struct row_end *end,
                                     enum row_state from, bool reused, struct talus_error *error)
{
    struct text sql = {0};
    /* Names of columns cannot be parameters of a statement; these are our own. */
    text_print(&sql,
               "UPDATE studies SET %s = %s - 1, reused = reused + %d, revision = revision + 1"
               " WHERE id = ?",
               row_state_name(from), row_state_name(from), (int)reused);
    enum talus_status status = study_run_text(database, &sql, end->study, error);
    if (status != TALUS_OK)
        return status;
    text_print(&sql, "UPDATE studies SET %s = %s + 1 WHERE id = ?", row_state_name(end->state),
               row_state_name(end->state));
    return study_run_text(database, &sql, end->study, error);
}

/* Writes a row as `end` says, with its metrics out of those of its job, and all that follows. */
static enum talus_status row_move(sqlite3 *database, const struct row_end *end,
                                  const struct row_place *place, bool reused, const char *at,
                                  struct talus_error *error)
{
    char *metrics = study_metrics_pick(place->wanted, end->metrics);
    sqlite3_stmt *statement = store_prepare(
        database,
        "UPDATE study_rows SET state = ?, job = ?, reused = ?, reason = ?, detail = ?,"
        " metrics = ? WHERE study = ? AND number = ?",
        error);
    if (statement != NULL) {
        (void)sqlite3_bind_int(statement, 1, (int)end->state);
        (void)sqlite3_bind_text(statement, 2, end->job, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int(statement, 3, (int)reused);
        (void)sqlite3_bind_text(statement, 4, end->reason, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 5, end->detail, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 6, metrics, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 7, end->study, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 8, end->number);
    }
    enum talus_status status = store_finish(database, statement, error);
    free(metrics);
    if (status == TALUS_OK)
        status = counts_move(database, end, place->state, reused, error);
    const struct study_transition transition = {.number = end->number,
                                                .at = at,
                                                .state = row_state_name(end->state),
                                                .job = end->job,
                                                .detail = end->detail};
    return status == TALUS_OK ? study_transition_write(database, end->study, &transition, error)
                              : status;
}

/* Moves a row that waits; any other is refused. */
static enum talus_status row_take(sqlite3 *database, const struct row_end *end, bool reused,
                                  const char *at, struct talus_error *error)
{
    struct row_place place = {0};
    enum talus_status status = place_find(database, end, &place, error);
    if (status == TALUS_OK)
        status = place.state != ROW_WAITING ? talus_error_set(error, TALUS_LIMIT, "state", "",
                                                              "the row of the study does not wait")
                                            : row_move(database, end, &place, reused, at, error);
    free(place.wanted);
    return status;
}

enum talus_status study_row_end(sqlite3 *database, const struct row_end *end,
                                struct talus_error *error)
{
    char now[MOMENT_TEXT_SIZE];
    moment_now_text(now);
    return row_take(database, end, end->job != NULL, now, error);
}

/* What a job makes of its row. */
static struct row_end end_of_job(const struct job *job)
{
    enum job_state state = (enum job_state)job->state;
    return (struct row_end){.study = job->study,
                            .number = job->study_row,
                            .state = row_state_of_job(state),
                            .job = job->id,
                            .reason = job->reason,
                            .detail = job->detail,
                            .metrics = job_state_final(state) ? job->metrics : NULL};
}

enum talus_status study_row_enter(sqlite3 *database, const struct job *job,
                                  struct talus_error *error)
{
    if (job->study == NULL)
        return TALUS_OK;
    const struct row_end end = end_of_job(job);
    return row_take(database, &end, false, job->changed_at, error);
}

enum talus_status study_row_follow(sqlite3 *database, const struct job *job,
                                   struct talus_error *error)
{
    if (job->study == NULL)
        return TALUS_OK;
    const struct row_end end = end_of_job(job);
    struct row_place place = {0};
    enum talus_status status = place_find(database, &end, &place, error);
    if (status == TALUS_OK && place.same_job && place.state != ROW_STATE_COUNT)
        status = row_move(database, &end, &place, false, job->changed_at, error);
    free(place.wanted);
    return status;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Lists of jobs and of transitions. */
#include "store.h"
#include "store_internal.h"
#include "store_row.h"
#include "text.h"

#include <stdio.h>
#include <string.h>

/* What a list walks over. Rows come in the order of an index, so that a page costs what is on it:
 * of the jobs themselves, of those with the label, or of their names, newest first. */
struct walk {
    const char *from;  /* what is walked over, and the condition that goes with it */
    const char *job;   /* the job's identifier there */
    const char *order; /* what sorts as identifiers do */
    const char *before;
    size_t label_first; /* the labels from here on are asked for one by one */
    bool joined;        /* something else than the jobs is walked over */
};

static const struct walk walk_jobs = {
    .from = " FROM jobs WHERE 1", .job = "id", .order = "id", .before = " AND id < :before"};
static const struct walk walk_label = {.from =
                                           " FROM job_labels AS tag CROSS JOIN jobs ON jobs.id = "
                                           "tag.job WHERE tag.key = :key0 AND tag.value = :value0",
                                       .job = "tag.job",
                                       .order = "tag.job",
                                       .before = " AND tag.job < :before",
                                       .label_first = 1,
                                       .joined = true};
/* Of a text with less than three characters; the longer ones have an index. */
static const struct walk walk_names = {
    .from = " FROM job_names AS tag CROSS JOIN jobs ON jobs.id = "
            "tag.job WHERE instr(tag.text, lower(:text)) > 0",
    .job = "tag.job",
    .order = "tag.number",
    .before = " AND tag.number <= " STORE_NUMBER(":before") " AND tag.job < :before",
    .joined = true};
/* The index of trigrams does not tell some letters apart that are different to us. */
static const struct walk walk_parts = {
    .from = " FROM job_name_parts AS part CROSS JOIN job_names AS tag ON tag.number = part.rowid"
            " CROSS JOIN jobs ON jobs.id = tag.job"
            " WHERE part.text MATCH :parts AND instr(tag.text, lower(:text)) > 0",
    .job = "tag.job",
    .order = "part.rowid",
    .before = " AND part.rowid <= " STORE_NUMBER(":before") " AND tag.job < :before",
    .joined = true};

static size_t character_count(const char *text)
{
    size_t count = 0;
    for (; *text != '\0'; text++)
        count += ((unsigned char)*text & 0xC0) != 0x80;
    return count;
}

static const struct walk *walk_choose(const struct store_filter *filter)
{
    /* A study has few jobs. */
    if (filter->text != NULL && filter->study == NULL && !filter->by_queue)
        return character_count(filter->text) < 3 ? &walk_names : &walk_parts;
    return filter->label_count > 0 ? &walk_label : &walk_jobs;
}

static void filter_sql(const struct store_filter *filter, struct text *sql)
{
    const struct walk *walk = walk_choose(filter);
    text_print(sql, "%s%s", store_row_select, walk->from);
    for (size_t index = walk->label_first; index < filter->label_count; index++)
        text_print(sql,
                   " AND EXISTS (SELECT 1 FROM job_labels AS other WHERE other.job = %s"
                   " AND other.key = :key%zu AND other.value = :value%zu)",
                   walk->job, index, index);
    if (!filter->every)
        text_add_string(sql, " AND deleting = 0");
    if (filter->text != NULL && walk != &walk_parts && walk != &walk_names)
        text_add_string(sql, " AND instr(lower(jobs.name), lower(:text)) > 0");
    if (filter->state != JOB_STATE_COUNT && walk->joined)
        text_print(sql,
                   " AND EXISTS (SELECT 1 FROM jobs AS same INDEXED BY jobs_by_state_newest"
                   " WHERE same.id = %s AND same.state = :state)",
                   walk->job);
    else if (filter->state != JOB_STATE_COUNT)
        text_add_string(sql, " AND state = :state");
    if (filter->study != NULL)
        text_add_string(sql, " AND study = :study");
    if (filter->before != NULL)
        text_add_string(sql, walk->before);
    if (filter->by_queue)
        text_add_string(sql, " ORDER BY priority DESC, id");
    else
        text_print(sql, " ORDER BY %s DESC", walk->order);
    if (filter->limit > 0)
        text_add_string(sql, " LIMIT :limit");
}

static void filter_bind_text(sqlite3_stmt *statement, const char *name, const char *value)
{
    int index = sqlite3_bind_parameter_index(statement, name);
    if (index > 0)
        (void)sqlite3_bind_text(statement, index, value, -1, SQLITE_STATIC);
}

static void filter_bind_labels(sqlite3_stmt *statement, const struct store_filter *filter)
{
    char key[32], value[32];
    for (size_t index = 0; index < filter->label_count; index++) {
        (void)snprintf(key, sizeof key, ":key%zu", index);
        (void)snprintf(value, sizeof value, ":value%zu", index);
        filter_bind_text(statement, key, filter->labels[index].key);
        filter_bind_text(statement, value, filter->labels[index].value);
    }
}

/* The text as a phrase of the index of trigrams; false without memory. */
static bool filter_bind_parts(sqlite3_stmt *statement, const char *text)
{
    struct text phrase = {0};
    int index = sqlite3_bind_parameter_index(statement, ":parts");
    if (index == 0)
        return true;
    text_add_string(&phrase, "\"");
    for (; *text != '\0'; text++)
        text_add(&phrase, *text == '"' ? "\"\"" : text, *text == '"' ? 2 : 1);
    text_add_string(&phrase, "\"");
    bool good = !phrase.failed &&
                sqlite3_bind_text(statement, index, phrase.data, -1, SQLITE_TRANSIENT) == SQLITE_OK;
    text_release(&phrase);
    return good;
}

static void filter_bind_integer(sqlite3_stmt *statement, const char *name, int64_t value)
{
    int index = sqlite3_bind_parameter_index(statement, name);
    if (index > 0)
        (void)sqlite3_bind_int64(statement, index, value);
}

static enum talus_status list_rows(sqlite3 *database, sqlite3_stmt *statement,
                                   bool (*visit)(const struct job *job, void *context),
                                   void *context, struct talus_error *error)
{
    int step = SQLITE_DONE;
    bool more = true;
    while (more && (step = sqlite3_step(statement)) == SQLITE_ROW) {
        struct job job = {0};
        store_row_read(statement, &job);
        more = visit(&job, context);
        job_release(&job);
    }
    return step == SQLITE_ROW || step == SQLITE_DONE ? TALUS_OK : store_failure(database, error);
}

enum talus_status store_job_list(struct store *store, const struct store_filter *filter,
                                 bool (*visit)(const struct job *job, void *context), void *context,
                                 struct talus_error *error)
{
    struct text sql = {0};
    filter_sql(filter, &sql);
    if (sql.failed)
        return talus_error_memory(error);
    (void)pthread_mutex_lock(&store->reader_mutex);
    enum talus_status status = TALUS_IO;
    sqlite3_stmt *statement = store_prepare(store->reader, sql.data, error);
    if (statement != NULL) {
        filter_bind_integer(statement, ":state", (int64_t)filter->state);
        filter_bind_integer(statement, ":limit", filter->limit);
        filter_bind_labels(statement, filter);
        filter_bind_text(statement, ":text", filter->text);
        filter_bind_text(statement, ":study", filter->study);
        filter_bind_text(statement, ":before", filter->before);
        status = filter_bind_parts(statement, filter->text)
                     ? list_rows(store->reader, statement, visit, context, error)
                     : talus_error_memory(error);
        store_release(statement);
    }
    (void)pthread_mutex_unlock(&store->reader_mutex);
    text_release(&sql);
    return status;
}

enum talus_status store_queue_heads(struct store *store,
                                    void (*visit)(const struct store_queued *job, void *context),
                                    void *context, struct talus_error *error)
{
    /* The index has everything, in this order. */
    static const char sql[] =
        "SELECT id, owner, threads, priority FROM ("
        "SELECT id, owner, threads, priority, deleting,"
        " row_number() OVER (PARTITION BY owner ORDER BY priority DESC, id) AS place"
        " FROM jobs INDEXED BY jobs_queued_by_owner WHERE state = 0) WHERE place <= 16"
        " AND deleting = 0";
    enum talus_status status = TALUS_IO;
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement = store_prepare(store->reader, sql, error);
    if (statement != NULL) {
        int step;
        while ((step = sqlite3_step(statement)) == SQLITE_ROW) {
            const struct store_queued job = {
                .id = (const char *)sqlite3_column_text(statement, 0),
                .owner = (const char *)sqlite3_column_text(statement, 1),
                .threads = sqlite3_column_int64(statement, 2),
                .priority = sqlite3_column_int64(statement, 3),
            };
            visit(&job, context);
        }
        status = step == SQLITE_DONE ? TALUS_OK : store_failure(store->reader, error);
        store_release(statement);
    }
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

enum talus_status store_job_counts(struct store *store, int64_t counts[JOB_STATE_COUNT],
                                   struct talus_error *error)
{
    enum talus_status status = TALUS_IO;
    memset(counts, 0, JOB_STATE_COUNT * sizeof *counts);
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement =
        store_prepare(store->reader, "SELECT state, count(*) FROM jobs GROUP BY state", error);
    if (statement != NULL) {
        int step;
        while ((step = sqlite3_step(statement)) == SQLITE_ROW) {
            int64_t state = sqlite3_column_int64(statement, 0);
            if (state >= 0 && state < JOB_STATE_COUNT)
                counts[state] = sqlite3_column_int64(statement, 1);
        }
        status = step == SQLITE_DONE ? TALUS_OK : store_failure(store->reader, error);
        store_release(statement);
    }
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

enum talus_status store_job_find_finished(struct store *store, const char *scene_hash,
                                          const char *build, char found[64],
                                          struct talus_error *error)
{
    static const char sql[] = "SELECT id FROM jobs WHERE scene_hash = ? AND build = ?"
                              " AND state = 2 AND steered = 0 AND deleting = 0 ORDER BY id LIMIT 1";
    _Static_assert(JOB_SUCCEEDED == 2, "the number is also in an index");
    enum talus_status status = TALUS_IO;
    found[0] = '\0';
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement = store_prepare(store->reader, sql, error);
    if (statement != NULL) {
        (void)sqlite3_bind_text(statement, 1, scene_hash, -1, SQLITE_STATIC);
        (void)sqlite3_bind_text(statement, 2, build, -1, SQLITE_STATIC);
        int step = sqlite3_step(statement);
        if (step == SQLITE_ROW)
            (void)snprintf(found, 64, "%s", (const char *)sqlite3_column_text(statement, 0));
        status = step == SQLITE_ROW || step == SQLITE_DONE ? TALUS_OK
                                                           : store_failure(store->reader, error);
        store_release(statement);
    }
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

static enum talus_status
transition_visit(sqlite3_stmt *statement,
                 enum talus_status (*visit)(const struct store_transition *transition,
                                            void *context, struct talus_error *error),
                 void *context, struct talus_error *error)
{
    const struct store_transition transition = {
        .number = sqlite3_column_int64(statement, 0),
        .at = (const char *)sqlite3_column_text(statement, 1),
        .state = (const char *)sqlite3_column_text(statement, 2),
        .attempt = sqlite3_column_int64(statement, 3),
        .reason = (const char *)sqlite3_column_text(statement, 4),
        .detail = (const char *)sqlite3_column_text(statement, 5),
    };
    return visit(&transition, context, error);
}

enum talus_status
store_transitions(struct store *store, const char *id, int64_t after,
                  enum talus_status (*visit)(const struct store_transition *transition,
                                             void *context, struct talus_error *error),
                  void *context, struct talus_error *error)
{
    enum talus_status status = TALUS_IO;
    (void)pthread_mutex_lock(&store->reader_mutex);
    sqlite3_stmt *statement =
        store_prepare(store->reader,
                      "SELECT number, at, state, attempt, reason, detail FROM transitions"
                      " WHERE job = ? AND number > ? ORDER BY number",
                      error);
    if (statement != NULL) {
        int step = SQLITE_DONE;
        status = TALUS_OK;
        (void)sqlite3_bind_text(statement, 1, id, -1, SQLITE_STATIC);
        (void)sqlite3_bind_int64(statement, 2, after);
        while (status == TALUS_OK && (step = sqlite3_step(statement)) == SQLITE_ROW)
            status = transition_visit(statement, visit, context, error);
        if (status == TALUS_OK && step != SQLITE_DONE)
            status = store_failure(store->reader, error);
        store_release(statement);
    }
    (void)pthread_mutex_unlock(&store->reader_mutex);
    return status;
}

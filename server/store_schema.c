/* SPDX-License-Identifier: Apache-2.0 */
/* The tables of the store. Everything here may run on a database of any age: what is missing is
 * added, so that a new column of a job is one line in job_columns.def and a new table one entry
 * below. The format's number grows only when older daemons must not touch what newer ones write. */
#include "store_internal.h"
#include "text.h"

#include <string.h>

enum { SCHEMA_VERSION = 2 };

struct column {
    const char *name, *declaration;
};

static const struct column job_columns[] = {
#define JOB_TEXT(name) {#name, #name " TEXT"},
#define JOB_INTEGER(name) {#name, #name " INTEGER NOT NULL DEFAULT 0"},
#define JOB_REAL(name) {#name, #name " REAL NOT NULL DEFAULT 0"},
#include "job_columns.def"
#undef JOB_TEXT
#undef JOB_INTEGER
#undef JOB_REAL
};

/* In order: an index comes behind the columns it is over, which jobs_prepare has added. */
static const char *const parts[] = {
    "CREATE INDEX IF NOT EXISTS jobs_by_state ON jobs (state, priority DESC, id)",
    "CREATE INDEX IF NOT EXISTS jobs_deleting ON jobs (id) WHERE deleting <> 0",
    /* Lists are told newest first. */
    "CREATE INDEX IF NOT EXISTS jobs_by_state_newest ON jobs (state, id)",
    "CREATE INDEX IF NOT EXISTS jobs_by_study_newest ON jobs (study, id) WHERE study IS NOT NULL",
    /* What the triggers below copy out of the column of labels. */
    "CREATE TABLE IF NOT EXISTS job_labels (key TEXT NOT NULL, value TEXT NOT NULL,"
    " job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE, PRIMARY KEY (key, value, job))"
    " WITHOUT ROWID",
    "CREATE INDEX IF NOT EXISTS job_labels_by_job ON job_labels (job)",
    "CREATE TRIGGER IF NOT EXISTS job_labels_of_new AFTER INSERT ON jobs"
    " WHEN new.labels IS NOT NULL BEGIN"
    " INSERT INTO job_labels SELECT key, value, new.id FROM json_each(new.labels); END",
    "CREATE TRIGGER IF NOT EXISTS job_labels_of_changed AFTER UPDATE OF labels ON jobs"
    " WHEN new.labels IS NOT old.labels BEGIN"
    " DELETE FROM job_labels WHERE job = new.id;"
    " INSERT INTO job_labels SELECT key, value, new.id FROM json_each(new.labels); END",
    /* What lists by a part of the name walk over: names in lower case (of ASCII letters, as SQLite
     * has it), newest last, and an index of their trigrams. */
    "CREATE TABLE IF NOT EXISTS job_names (number INTEGER PRIMARY KEY, text TEXT NOT NULL,"
    " job TEXT NOT NULL UNIQUE REFERENCES jobs (id) ON DELETE CASCADE)",
    "CREATE VIRTUAL TABLE IF NOT EXISTS job_name_parts USING fts5 (text, content = 'job_names',"
    " content_rowid = 'number', tokenize = 'trigram', columnsize = 0)",
    "CREATE TRIGGER IF NOT EXISTS job_name_parts_of_new AFTER INSERT ON job_names BEGIN"
    " INSERT INTO job_name_parts (rowid, text) VALUES (new.number, new.text); END",
    "CREATE TRIGGER IF NOT EXISTS job_name_parts_of_old AFTER DELETE ON job_names BEGIN"
    " INSERT INTO job_name_parts (job_name_parts, rowid, text)"
    " VALUES ('delete', old.number, old.text); END",
    /* Takes names in. Identifiers of one millisecond that two machines made may want one number. */
    "CREATE VIEW IF NOT EXISTS job_names_entrance AS SELECT id, name FROM jobs",
    "CREATE TRIGGER IF NOT EXISTS job_names_enter INSTEAD OF INSERT ON job_names_entrance"
    " WHEN new.name IS NOT NULL BEGIN"
    " INSERT INTO job_names (number, text, job)"
    " SELECT CASE WHEN NOT EXISTS (SELECT 1 FROM job_names AS same WHERE same.number ="
    " wanted.number) THEN wanted.number ELSE (SELECT taken.number + 1 FROM job_names AS taken"
    " WHERE taken.number >= wanted.number AND NOT EXISTS"
    " (SELECT 1 FROM job_names AS next WHERE next.number = taken.number + 1)"
    " ORDER BY taken.number LIMIT 1) END, lower(new.name), new.id"
    " FROM (SELECT " STORE_NUMBER("new.id") " AS number) AS wanted; END",
    "CREATE TRIGGER IF NOT EXISTS job_names_of_new AFTER INSERT ON jobs BEGIN"
    " INSERT INTO job_names_entrance VALUES (new.id, new.name); END",
    "CREATE TRIGGER IF NOT EXISTS job_names_of_changed AFTER UPDATE OF name ON jobs"
    " WHEN new.name IS NOT old.name BEGIN DELETE FROM job_names WHERE job = new.id;"
    " INSERT INTO job_names_entrance VALUES (new.id, new.name); END",
    "CREATE INDEX IF NOT EXISTS jobs_queued_by_owner ON jobs"
    " (state, owner, priority DESC, id, threads, deleting)",
    /* Of what may answer for another job of the same scene. */
    "CREATE INDEX IF NOT EXISTS jobs_by_scene ON jobs (scene_hash, build, id)"
    " WHERE state = 2 AND steered = 0 AND deleting = 0",
    "CREATE TABLE IF NOT EXISTS transitions (row INTEGER PRIMARY KEY AUTOINCREMENT,"
    " job TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE, number INTEGER NOT NULL,"
    " at TEXT NOT NULL, state TEXT NOT NULL, attempt INTEGER NOT NULL, reason TEXT, detail TEXT,"
    " UNIQUE (job, number))",
    /* One row: up to which row of `transitions` the state lines are in their files. */
    "CREATE TABLE IF NOT EXISTS told (id INTEGER PRIMARY KEY, row INTEGER NOT NULL)",
    /* Of jobs and of studies: whoever removes a resource removes its keys. */
    "CREATE TABLE IF NOT EXISTS request_keys (key TEXT NOT NULL, owner TEXT NOT NULL,"
    " body TEXT NOT NULL, resource TEXT NOT NULL, PRIMARY KEY (owner, key)) WITHOUT ROWID",
    "CREATE INDEX IF NOT EXISTS request_keys_by_resource ON request_keys (resource)",
    "CREATE UNIQUE INDEX IF NOT EXISTS jobs_by_study ON jobs (study, study_row)"
    " WHERE study IS NOT NULL",
    "CREATE TABLE IF NOT EXISTS studies (id TEXT PRIMARY KEY"
#define ROW_STATE(ENUM, name) ", " #name " INTEGER NOT NULL DEFAULT 0"
#define STUDY_TEXT(name) ", " #name " TEXT"
#define STUDY_LONG_TEXT(name) ", " #name " TEXT"
#define STUDY_INTEGER(name) ", " #name " INTEGER NOT NULL"
#include "studies/row_states.def"
#include "studies/study_columns.def"
#undef ROW_STATE
#undef STUDY_TEXT
#undef STUDY_LONG_TEXT
#undef STUDY_INTEGER
    ") WITHOUT ROWID",
    /* `job` may name one that is gone: the row keeps what it showed. */
    "CREATE TABLE IF NOT EXISTS study_rows ("
    "study TEXT NOT NULL REFERENCES studies (id) ON DELETE CASCADE, number INTEGER NOT NULL,"
    " state INTEGER NOT NULL, reused INTEGER NOT NULL DEFAULT 0, parameters TEXT NOT NULL,"
    " settings TEXT NOT NULL, job TEXT, reason TEXT, detail TEXT, metrics TEXT,"
    " PRIMARY KEY (study, number)) WITHOUT ROWID",
    "CREATE INDEX IF NOT EXISTS study_rows_by_state ON study_rows (study, state, number)",
    /* Of a study (number -1) and of its rows; `row` goes on counting those of `transitions`. */
    "CREATE TABLE IF NOT EXISTS study_transitions (row INTEGER PRIMARY KEY,"
    " study TEXT NOT NULL REFERENCES studies (id) ON DELETE CASCADE, number INTEGER NOT NULL,"
    " at TEXT NOT NULL, state TEXT NOT NULL, job TEXT, detail TEXT)",
    /* Statistics of runs on a machine (calibration.h), and one row on how good forecasts were. */
    "CREATE TABLE IF NOT EXISTS calibration (name TEXT PRIMARY KEY, processor TEXT NOT NULL,"
    " build TEXT NOT NULL, count INTEGER NOT NULL, weight REAL NOT NULL, mean REAL NOT NULL,"
    " variance REAL NOT NULL, used INTEGER NOT NULL) WITHOUT ROWID",
    "CREATE TABLE IF NOT EXISTS forecast_quality (id INTEGER PRIMARY KEY,"
    " judged INTEGER NOT NULL, inside INTEGER NOT NULL, recent REAL NOT NULL)",
    "CREATE INDEX IF NOT EXISTS study_transitions_by_study ON study_transitions (study, row)",
};

/* What format 1 had otherwise. */
static const char from_1[] = "INSERT INTO request_keys (key, owner, body, resource)"
                             " SELECT key, owner, body, job FROM idempotency;"
                             "DROP TABLE idempotency;"
                             "UPDATE jobs SET owner = '' WHERE owner IS NULL;";

/* What a database without the tables of labels or names has not copied yet. */
static const char labels_fill[] = "INSERT INTO job_labels SELECT label.key, label.value, jobs.id"
                                  " FROM jobs, json_each(jobs.labels) AS label";
static const char names_fill[] = "INSERT INTO job_names_entrance SELECT id, name FROM jobs";

static bool column_exists(sqlite3 *database, const char *table, const char *name, bool *exists)
{
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(database, "SELECT 1 FROM pragma_table_info(?) WHERE name = ?", -1,
                           &statement, NULL) != SQLITE_OK)
        return false;
    (void)sqlite3_bind_text(statement, 1, table, -1, SQLITE_STATIC);
    (void)sqlite3_bind_text(statement, 2, name, -1, SQLITE_STATIC);
    int step = sqlite3_step(statement);
    *exists = step == SQLITE_ROW;
    (void)sqlite3_finalize(statement);
    return step == SQLITE_ROW || step == SQLITE_DONE;
}

static bool jobs_prepare(sqlite3 *database)
{
    bool good = store_execute(database, "CREATE TABLE IF NOT EXISTS jobs (id TEXT PRIMARY KEY)"
                                        " WITHOUT ROWID");
    for (size_t index = 0; good && index < sizeof job_columns / sizeof job_columns[0]; index++) {
        struct text sql = {0};
        bool exists = false;
        text_print(&sql, "ALTER TABLE jobs ADD COLUMN %s", job_columns[index].declaration);
        good = !sql.failed && column_exists(database, "jobs", job_columns[index].name, &exists) &&
               (exists || store_execute(database, sql.data));
        text_release(&sql);
    }
    return good;
}

static bool tables_prepare(sqlite3 *database, int version)
{
    struct text sql = {0};
    bool labelled = false, named = false;
    bool good = column_exists(database, "job_labels", "job", &labelled) &&
                column_exists(database, "job_names", "job", &named) && jobs_prepare(database);
    for (size_t index = 0; good && index < sizeof parts / sizeof parts[0]; index++)
        good = store_execute(database, parts[index]);
    if (!labelled)
        good = good && store_execute(database, labels_fill);
    if (!named)
        good = good && store_execute(database, names_fill);
    if (version == 1)
        good = good && store_execute(database, from_1);
    text_print(&sql, "PRAGMA user_version = %d", SCHEMA_VERSION);
    good = good && !sql.failed && store_execute(database, sql.data);
    text_release(&sql);
    return good;
}

static int version_read(sqlite3 *database)
{
    struct talus_error error = {0};
    sqlite3_stmt *statement = store_prepare(database, "PRAGMA user_version", &error);
    int version = statement != NULL && sqlite3_step(statement) == SQLITE_ROW
                      ? sqlite3_column_int(statement, 0)
                      : -1;
    (void)sqlite3_finalize(statement);
    return version;
}

enum talus_status store_schema_prepare(sqlite3 *database, struct talus_error *error)
{
    int version = version_read(database);
    if (version < 0)
        return store_failure(database, error);
    if (version > SCHEMA_VERSION)
        return talus_error_set(error, TALUS_IO, "version", "",
                               "the state was written by a newer talusd (format %d, this one "
                               "knows up to %d)",
                               version, SCHEMA_VERSION);
    if (store_execute(database, "BEGIN IMMEDIATE") && tables_prepare(database, version) &&
        store_execute(database, "COMMIT"))
        return TALUS_OK;
    enum talus_status status = store_failure(database, error);
    if (sqlite3_get_autocommit(database) == 0)
        (void)store_execute(database, "ROLLBACK");
    return status;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the files of the store: the connections and the queue of writes. */
#ifndef TALUS_STORE_INTERNAL_H
#define TALUS_STORE_INTERNAL_H

#include "store.h"

#include <pthread.h>
#include <sqlite3.h>
#include <stdatomic.h>

/* A write, applied on the store's thread inside a transaction of its own (a savepoint). */
typedef enum talus_status store_apply(sqlite3 *database, void *context, struct talus_error *error);

struct store_write {
    store_apply *apply;
    void *context;
    enum talus_status status;
    struct talus_error *error;
    bool done;
    struct store_write *next;
};

/* Statements' text for the number of a job in job_names: the milliseconds of its identifier, then
 * its last 15 bits, which grow within a millisecond (identifier.h). So numbers sort as identifiers
 * do. */
#define STORE_NUMBER_DIGIT(id, place, shift)                                                       \
    " | (instr('0123456789abcdefghjkmnpqrstvwxyz', substr(" id "," #place ",1)) - 1 << " #shift ")"
/* clang-format off */
#define STORE_NUMBER(id)                                                                           \
    "(0" STORE_NUMBER_DIGIT(id, 1, 60) STORE_NUMBER_DIGIT(id, 2, 55)                               \
    STORE_NUMBER_DIGIT(id, 3, 50) STORE_NUMBER_DIGIT(id, 4, 45) STORE_NUMBER_DIGIT(id, 5, 40)      \
    STORE_NUMBER_DIGIT(id, 6, 35) STORE_NUMBER_DIGIT(id, 7, 30) STORE_NUMBER_DIGIT(id, 8, 25)      \
    STORE_NUMBER_DIGIT(id, 9, 20) STORE_NUMBER_DIGIT(id, 10, 15) STORE_NUMBER_DIGIT(id, 24, 10)    \
    STORE_NUMBER_DIGIT(id, 25, 5) STORE_NUMBER_DIGIT(id, 26, 0) ")"
/* clang-format on */

struct store {
    sqlite3 *writer, *reader;
    pthread_mutex_t mutex, reader_mutex; /* of the queue; of `reader` */
    pthread_cond_t queued, committed;
    pthread_t thread;
    struct store_write *first, *last;
    atomic_uint_fast64_t commit_count;
    bool stopping, broken, started;
};

/* Queues a write and waits until it is on disk. */
TALUS_MUST_CHECK enum talus_status store_write(struct store *store, store_apply *apply,
                                               void *context, struct talus_error *error);
/* A statement of this text, without values: one that was released, or a new one; NULL with *error
 * set. Give it back by store_release, or finalize it if its text will not come again. */
sqlite3_stmt *store_prepare(sqlite3 *database, const char *sql, struct talus_error *error);
/* Ends the use of a statement, which the connection keeps for the next of this text. */
void store_release(sqlite3_stmt *statement);
/* Steps a statement that returns no rows, then releases it (NULL fails). */
TALUS_MUST_CHECK enum talus_status store_finish(sqlite3 *database, sqlite3_stmt *statement,
                                                struct talus_error *error);
/* Steps through what a statement yields, until `visit` has enough, then releases it (NULL fails).
 */
TALUS_MUST_CHECK enum talus_status store_visit(sqlite3 *database, sqlite3_stmt *statement,
                                               bool (*visit)(sqlite3_stmt *statement,
                                                             void *context),
                                               void *context, struct talus_error *error);
/* A copy of a text in a row (free() it), NULL for NULL. */
char *store_column_copy(sqlite3_stmt *statement, int column);
/* Runs a statement that returns nothing and has one parameter. */
TALUS_MUST_CHECK enum talus_status store_run_for(sqlite3 *database, const char *sql, const char *id,
                                                 struct talus_error *error);
/* Removes a resource and its keys; the parameter of the statement is its id (store_job.c). */
TALUS_MUST_CHECK enum talus_status store_remove(struct store *store, const char *sql,
                                                const char *id, struct talus_error *error);
/* Looks a key up, notes whose resource it is, forgets all keys of a resource (store_job.c). */
TALUS_MUST_CHECK enum talus_status store_key_look(sqlite3 *database, const struct store_key *key,
                                                  enum store_insert *result, char existing[64],
                                                  struct talus_error *error);
TALUS_MUST_CHECK enum talus_status store_key_write(sqlite3 *database, const struct store_key *key,
                                                   const char *resource, struct talus_error *error);
TALUS_MUST_CHECK enum talus_status store_keys_remove(sqlite3 *database, const char *resource,
                                                     struct talus_error *error);
/* Runs statements that return nothing. */
bool store_execute(sqlite3 *database, const char *sql);
enum talus_status store_failure(sqlite3 *database, struct talus_error *error);
/* Makes the tables of a new database, or brings those of an older daemon up to date, in one
 * transaction. TALUS_IO, code "version", if a newer one wrote them (store_schema.c). */
TALUS_MUST_CHECK enum talus_status store_schema_prepare(sqlite3 *database,
                                                        struct talus_error *error);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Jobs on disk: SQLite in WAL mode with synchronous=FULL, so that what was acknowledged survives a
 * power cut. One thread writes; requests that wait at the same time share one commit. Any thread
 * may call any function. */
#ifndef TALUS_STORE_H
#define TALUS_STORE_H

#include "job.h"
#include "talus/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct store;

/* An idempotency key of a principal ("" without a token) with the checksum of the body it came
 * with. */
struct store_key {
    const char *owner, *key, *body;
};

enum store_insert {
    STORE_INSERTED,
    STORE_REPLAYED,   /* the key is known with this body: `existing` is its resource */
    STORE_OTHER_BODY, /* the key is known with another body */
    STORE_QUEUE_FULL,
    STORE_QUOTA_QUEUED, /* the owner has as many queued jobs as allowed */
    STORE_QUOTA_DISK,   /* the owner's jobs take as much disk as allowed, by their forecasts */
};

/* What bounds an insertion; 0: no bound. */
struct store_limits {
    int64_t queued;       /* of all */
    int64_t owner_queued; /* of the job's owner */
    double owner_disk;    /* [bytes] of all jobs of the owner, this one included */
};

struct store_label {
    const char *key, *value;
};

enum { STORE_LABEL_MAX = 16 };

/* Which jobs a list shows, newest first. Everything is borrowed and optional (NULL, 0). */
struct store_filter {
    enum job_state state;                       /* JOB_STATE_COUNT: all */
    struct store_label labels[STORE_LABEL_MAX]; /* all of these */
    size_t label_count;
    const char *text;   /* part of the name; the case of ASCII letters does not count */
    const char *study;  /* only its jobs */
    const char *before; /* only jobs with a smaller id */
    int64_t limit;
    bool every;    /* also those being deleted */
    bool by_queue; /* highest priority first, then oldest first */
};

/* A change of state as the transition table has it; texts are borrowed. */
struct store_transition {
    int64_t number, attempt;
    const char *at, *state, *reason, *detail;
};

/* A row of the transition tables: of a job or of a study; texts are borrowed. */
struct store_change {
    int64_t row, attempt;
    bool study;
    const char *id, *at, *state, *reason, *detail;
};

/* Opens or makes the database and starts the writer. TALUS_IO if it cannot be opened or was written
 * by a newer version. */
TALUS_MUST_CHECK enum talus_status store_open(const char *path, struct store **store,
                                              struct talus_error *error);
/* Commits what waits, then closes. NULL is fine. */
void store_close(struct store *store);
/* Grows with every commit, before those who wait for it go on: what was read at one count holds
 * while the count is the same. */
uint64_t store_commit_count(const struct store *store);
/* Whether commits work. */
bool store_healthy(struct store *store);

/* Inserts a new job, with its key if there is one, in one transaction. *limits
 * (NULL: none) are not exceeded. */
TALUS_MUST_CHECK enum talus_status store_job_insert(struct store *store, const struct job *job,
                                                    const struct store_key *key,
                                                    const struct store_limits *limits,
                                                    enum store_insert *result, char existing[64],
                                                    struct talus_error *error);
/* Looks a key up without inserting: STORE_INSERTED stands for an unknown key. */
TALUS_MUST_CHECK enum talus_status store_key_find(struct store *store, const struct store_key *key,
                                                  enum store_insert *result, char existing[64],
                                                  struct talus_error *error);
/* Reads a job into an empty *job (release it). TALUS_INVALID, code "not_found", if it does not
 * exist or is being deleted. */
TALUS_MUST_CHECK enum talus_status store_job_read(struct store *store, const char *id,
                                                  struct job *job, struct talus_error *error);
/* Reads a job, lets `change` alter it, and writes it back with the next revision, all in one
 * transaction; a new state adds a row to the transition table. Nothing is written when `change`
 * fails. `change` runs on the store's thread. *result (or NULL) gets the job as it now is. */
TALUS_MUST_CHECK enum talus_status store_job_change(
    struct store *store, const char *id,
    enum talus_status (*change)(struct job *job, void *context, struct talus_error *error),
    void *context, struct job *result, struct talus_error *error);
/* Forgets a job, its keys and its transitions. */
TALUS_MUST_CHECK enum talus_status store_job_remove(struct store *store, const char *id,
                                                    struct talus_error *error);
/* Visits jobs until `visit` is false; it must not call the store. */
TALUS_MUST_CHECK enum talus_status
store_job_list(struct store *store, const struct store_filter *filter,
               bool (*visit)(const struct job *job, void *context), void *context,
               struct talus_error *error);
/* What the scheduler wants to know of a queued job; texts are borrowed. */
struct store_queued {
    const char *id, *owner;
    int64_t threads, priority;
};

/* Visits the first few queued jobs of every owner. */
TALUS_MUST_CHECK enum talus_status
store_queue_heads(struct store *store, void (*visit)(const struct store_queued *job, void *context),
                  void *context, struct talus_error *error);
/* How many jobs there are in each state. */
TALUS_MUST_CHECK enum talus_status
store_job_counts(struct store *store, int64_t counts[JOB_STATE_COUNT], struct talus_error *error);
/* Finds the oldest job that has succeeded with a scene (by its hash) under a build of the solver,
 * and was not steered; `found` stays empty if there is none. */
TALUS_MUST_CHECK enum talus_status store_job_find_finished(struct store *store,
                                                           const char *scene_hash,
                                                           const char *build, char found[64],
                                                           struct talus_error *error);
/* Visits a job's transitions with a number above `after`, in order; `visit` must not call the
 * store. */
TALUS_MUST_CHECK enum talus_status
store_transitions(struct store *store, const char *id, int64_t after,
                  enum talus_status (*visit)(const struct store_transition *transition,
                                             void *context, struct talus_error *error),
                  void *context, struct talus_error *error);

/* Visits at most `limit` transitions of all jobs and studies behind a row, in order, until `visit`
 * is false; it must not call the store. */
TALUS_MUST_CHECK enum talus_status store_changes(struct store *store, int64_t after, int64_t limit,
                                                 bool (*visit)(const struct store_change *change,
                                                               void *context),
                                                 void *context, struct talus_error *error);
/* The last row there was. */
TALUS_MUST_CHECK enum talus_status store_changes_last(struct store *store, int64_t *row,
                                                      struct talus_error *error);

#endif

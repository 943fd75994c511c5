/* SPDX-License-Identifier: Apache-2.0 */
/* Studies on disk: the study, its rows and their transitions, which share their numbering with the
 * transitions of jobs. The row of a job is changed in the transaction that changes the job, so that
 * neither is without the other after a kill at any instant. */
#ifndef TALUS_STUDY_STORE_H
#define TALUS_STUDY_STORE_H

#include "store.h"
#include "studies/study.h"

#include <jansson.h>

/* Which studies a list shows, newest first. */
struct study_filter {
    enum study_state state; /* STUDY_STATE_COUNT: all */
    const char *before;     /* only studies with a smaller id, or NULL */
    int64_t limit;          /* 0: no limit */
    bool deleting;          /* those that are being deleted instead of all others */
};

/* Which rows are visited, in order. */
struct row_filter {
    enum row_state state; /* ROW_STATE_COUNT: all */
    int64_t from;         /* the first number */
    int64_t limit;        /* 0: no limit */
};

/* A change of a study's state (number -1) or of a row's. Texts are borrowed. */
struct study_transition {
    int64_t row, number;
    const char *at, *state, *job, *detail;
};

/* Changes of a study in one transaction. */
struct study_change {
    /* Alters the study, which is read without its long texts: state, detail, cancel_requested,
     * deleting (of its own jobs too), finished_at, result and rows_expected are written back.
     * Nothing is written when it fails. Runs on the store's thread. */
    enum talus_status (*apply)(struct study *study, struct study_change *change,
                               struct talus_error *error);
    void *context;
    json_t *rows;        /* rows to append, in the form of struct study_plan, or NULL (borrowed) */
    bool cancel_waiting; /* rows that wait are cancelled */
};

/* How a row ends that becomes no job: it shows another's result, or it cannot be started. */
struct row_end {
    const char *study;
    int64_t number;
    enum row_state state;
    const char *job, *reason, *detail, *metrics;
};

/* Inserts a study with its rows (in the form of struct study_plan) and its key, if there is one. */
TALUS_MUST_CHECK enum talus_status study_store_insert(struct store *store,
                                                      const struct study *study, const json_t *rows,
                                                      const struct store_key *key,
                                                      enum store_insert *result, char existing[64],
                                                      struct talus_error *error);
/* Reads a study into an empty *study (release it), with or without its long texts. TALUS_INVALID,
 * code "not_found", if it does not exist or is being deleted. */
TALUS_MUST_CHECK enum talus_status study_store_read(struct store *store, const char *id, bool whole,
                                                    struct study *study, struct talus_error *error);
/* Visits studies, without long texts, until `visit` is false; it must not call the store. */
TALUS_MUST_CHECK enum talus_status
study_store_list(struct store *store, const struct study_filter *filter,
                 bool (*visit)(const struct study *study, void *context), void *context,
                 struct talus_error *error);
/* *result (or NULL) gets the study as it now is. */
TALUS_MUST_CHECK enum talus_status study_store_change(struct store *store, const char *id,
                                                      struct study_change *change,
                                                      struct study *result,
                                                      struct talus_error *error);
/* Visits rows until `visit` is false; it must not call the store. A job that has been deleted is
 * not named, though its row keeps what it showed. */
TALUS_MUST_CHECK enum talus_status
study_store_rows(struct store *store, const char *id, const struct row_filter *filter,
                 bool (*visit)(const struct study_row *row, void *context), void *context,
                 struct talus_error *error);
/* Adds the ids of the jobs of the rows in a state. */
TALUS_MUST_CHECK enum talus_status study_store_row_jobs(struct store *store, const char *id,
                                                        enum row_state state, json_t *ids,
                                                        struct talus_error *error);
/* TALUS_LIMIT, code "state", if the row does not wait. */
TALUS_MUST_CHECK enum talus_status
study_store_row_end(struct store *store, const struct row_end *end, struct talus_error *error);
/* Visits the transitions of a study and of its rows behind number `after`, in order, until `visit`
 * is false; it must not call the store. */
TALUS_MUST_CHECK enum talus_status
study_store_transitions(struct store *store, const char *id, int64_t after,
                        bool (*visit)(const struct study_transition *transition, void *context),
                        void *context, struct talus_error *error);
/* Visits the studies that have changed since transition *after, and moves it to the last one. */
TALUS_MUST_CHECK enum talus_status study_store_changes(struct store *store, int64_t *after,
                                                       bool (*visit)(const char *id, void *context),
                                                       void *context, struct talus_error *error);
/* The ids of its own jobs, as a JSON array: new reference. */
TALUS_MUST_CHECK enum talus_status study_store_jobs(struct store *store, const char *id,
                                                    json_t **ids, struct talus_error *error);
/* Forgets a study with its rows, keys and transitions. */
TALUS_MUST_CHECK enum talus_status study_store_remove(struct store *store, const char *id,
                                                      struct talus_error *error);

#endif

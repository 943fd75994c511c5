/* SPDX-License-Identifier: Apache-2.0 */
/* A study that runs, as its driver knows it. Used by the driver's thread alone. */
#ifndef TALUS_STUDY_RUN_H
#define TALUS_STUDY_RUN_H

#include "helper.h"
#include "service.h"
#include "studies/study.h"

/* Owns texts, JSON and the plan. */
struct study_run {
    struct study study;  /* without long texts, as last read */
    json_t *scene;       /* as sent, once a row was started */
    json_t *options;     /* of its jobs */
    bool stopped;        /* its jobs have been told to stop */
    int helper_failures; /* of the row that is next, in a row */
    uint64_t turn;       /* when it last started a row */
    struct study_run *next;
};

enum row_start {
    ROW_STARTED,   /* it is a job now, or has ended */
    ROW_NOT_NOW,   /* try again later */
    ROW_NONE_LEFT, /* no row waits */
};

/* NULL without memory. */
struct study_run *study_run_create(void);
void study_run_destroy(struct study_run *run);
/* Starts the next row that waits. */
enum row_start study_run_start_row(struct study_run *run, struct service *service,
                                   struct helper *helper);
/* What is due when every row so far has ended: the study ends, or a bisection takes its next step.
 */
TALUS_MUST_CHECK enum talus_status study_run_settle(struct study_run *run, struct service *service,
                                                    struct talus_error *error);
/* Stops the jobs of a study that is to be cancelled. */
TALUS_MUST_CHECK enum talus_status study_run_stop(struct study_run *run, struct service *service,
                                                  struct talus_error *error);

#endif

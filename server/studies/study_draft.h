/* SPDX-License-Identifier: Apache-2.0 */
/* A study as it was sent, before it is stored: read and checked. */
#ifndef TALUS_STUDY_DRAFT_H
#define TALUS_STUDY_DRAFT_H

#include "helper.h"
#include "service.h"
#include "studies/study.h"

#include <jansson.h>

/* What the rows come to. */
struct study_totals {
    double rows, reused;
    double steps, disk, memory; /* memory: of the largest */
    double wall[3], longest[3]; /* [s]: low, expected, high; sums, and of the longest row */
};

/* Owns everything but `scene`. A zeroed draft is empty. */
struct study_draft {
    struct study study; /* all but id, times and forecast */
    struct study_plan plan;
    const json_t *scene; /* of the body */
    json_t *rows;        /* those to be checked; a bisection: its ends */
    json_t *wanted;      /* names of metrics */
    int64_t threads;     /* of each job */
    struct study_totals totals;
    json_t *advice; /* about the scene of the first row */
};

/* Whether a body is one of a study. */
bool study_draft_is(const json_t *body);
/* Reads a body into an empty draft and adds each mistake to *errors. The body must outlive it. */
void study_draft_read(const json_t *body, const struct config *config, struct study_draft *draft,
                      json_t *errors);
/* Has all scenes of a draft without mistakes checked, and adds what is wrong with them, row by row;
 * sums the forecasts and writes them into the study. */
TALUS_MUST_CHECK enum talus_status study_draft_check(struct study_draft *draft,
                                                     struct service *service, struct helper *helper,
                                                     json_t *errors, struct talus_error *error);
/* The answer of a forecast; new reference. */
json_t *study_draft_forecast(const struct study_draft *draft);
void study_draft_release(struct study_draft *draft);

#endif

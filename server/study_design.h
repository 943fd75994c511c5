/* SPDX-License-Identifier: Apache-2.0 */
/* What a study varies: its design, checked and written out as one row for each job. Pure functions
 * on JSON: no store, no HTTP, no clock. */
#ifndef TALUS_STUDY_DESIGN_H
#define TALUS_STUDY_DESIGN_H

#include "study_bisect.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

enum study_kind { STUDY_GRID, STUDY_LIST, STUDY_SAMPLE, STUDY_WORK_PRECISION, STUDY_BISECT };

/* A zeroed struct is empty; study_plan_release accepts it. The strings belong to the plan. Rows
 * share values with each other and with the design: read them only. */
struct study_plan {
    enum study_kind kind;
    json_t *names; /* array of strings: what `parameters` of each row holds, in this order */
    json_t *rows;  /* array of { "parameters": {NAME: value or label}, "set": {POINTER: value} }.
                    * The rows of a bisection follow from answers (study_bisect_row): these are what
                    * it is repeated for, at least one, and that sets nothing without "for_each" */
    const char *error_metric, *cost_metric; /* work_precision; NULL otherwise */
    struct study_bisect bisect;             /* bisect */
    json_t *design;                         /* what was read */
};

/* Checks a design against the scene as sent and expands it. Each mistake is added to `errors` with
 * a pointer into the request ("/design/grid/set/..."). A design with more than `rows_max` rows is
 * refused before anything is expanded, and so is a bisection that could take more runs. False if
 * there are mistakes; the plan is then empty. `scene` may be anything that JSON can hold. */
bool study_plan_read(const json_t *scene, const json_t *design, size_t rows_max,
                     struct study_plan *plan, json_t *errors);
void study_plan_release(struct study_plan *plan);

/* How many jobs the study makes; for a bisection, how many at most. */
size_t study_plan_count(const struct study_plan *plan);

/* The scene of a row: a new reference that shares what the row does not touch with `scene`, so that
 * both are to be read only. NULL without memory, or if a pointer of `set` leads nowhere, which
 * cannot be after study_plan_read took the design for the same scene. */
json_t *study_scene(const json_t *scene, const json_t *set);

/* The row of a bisection that tries a value, in one of plan->rows: a new reference of their form.
 */
json_t *study_bisect_row(const struct study_plan *plan, const json_t *repeated, double value);

#endif

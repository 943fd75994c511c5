/* SPDX-License-Identifier: Apache-2.0 */
/* A study as it is sent and as it is answered (study_view.c, study_results.c). */
#include "schemas.h"
#include "studies/study.h"
#include "submission.h"

enum { METRICS_MAX = 64 };

static const struct json_field metric_name = {.kind = FIELD_TEXT,
                                              .most = SUBMISSION_NAME_CHARACTERS};
static const struct json_field anything = {.kind = FIELD_ANY};
static const struct json_field chart_fields[] = {
    {.key = "x", .kind = FIELD_TEXT, .offset = FIELD_NOWHERE, .meaning = "parameter or metric"},
    {.key = "y", .kind = FIELD_TEXT, .offset = FIELD_NOWHERE, .meaning = "parameter or metric"},
    {.key = "series",
     .kind = FIELD_TEXT,
     .optional = true,
     .offset = FIELD_NOWHERE,
     .meaning = "parameter: a line for each value"},
    {.key = "z",
     .kind = FIELD_TEXT,
     .optional = true,
     .offset = FIELD_NOWHERE,
     .meaning = "metric: contours over the parameters x and y"},
    {.key = "log",
     .kind = FIELD_ANY,
     .optional = true,
     .offset = FIELD_NOWHERE,
     .meaning = "logarithmic axes: true, x, y, xy or a list of these"},
    {.key = NULL},
};

/* A study as it is sent. What its jobs are submitted with is read into a job. */
#define STUDY_FIELDS(job_alone)                                                                    \
    SUBMISSION_FIELDS(job_alone),                                                                  \
        {.key = "reuse",                                                                           \
         .kind = FIELD_BOOLEAN,                                                                    \
         .optional = true,                                                                         \
         .offset = FIELD_NOWHERE,                                                                  \
         .meaning = "take results of finished jobs of the same scene and build; a study does "     \
                    "unless false, a job only with true"},                                         \
        {.key = "design",                                                                          \
         .kind = FIELD_MAP,                                                                        \
         .optional = job_alone,                                                                    \
         .item = &anything,                                                                        \
         .offset = FIELD_NOWHERE,                                                                  \
         .meaning = "one of grid, list, sample, work_precision, bisect"},                          \
        {.key = "metrics",                                                                         \
         .kind = FIELD_LIST,                                                                       \
         .optional = job_alone,                                                                    \
         .most = METRICS_MAX,                                                                      \
         .item = &metric_name,                                                                     \
         .offset = FIELD_NOWHERE,                                                                  \
         .meaning = "columns of the results"},                                                     \
    {                                                                                              \
        .key = "chart", .kind = FIELD_OBJECT, .optional = true, .fields = chart_fields,            \
        .meaning = "what chart.svg draws"                                                          \
    }

static const struct json_field study_fields[] = {STUDY_FIELDS(false), {.key = NULL}};
static const struct json_field question_fields[] = {STUDY_FIELDS(true), {.key = NULL}};
const struct json_field schema_study_submission = {
    .kind = FIELD_OBJECT, .schema = "StudySubmission", .fields = study_fields};
const struct json_field schema_forecast_question = {
    .kind = FIELD_OBJECT,
    .schema = "ForecastQuestion",
    .fields = question_fields,
    .meaning = "a submission of a job or, with a design, of a study"};

static const struct json_field count_members[] = {
#define ROW_STATE(ENUM, name) MEMBER(INTEGER, #name, NULL),
#include "row_states.def"
#undef ROW_STATE
    MEMBER(INTEGER, "reused", "of those that succeeded: a job that was there before"),
    MEMBER(INTEGER, "total", "rows so far"),
    MEMBER_END,
};

static const struct json_field progress_members[] = {
    MEMBER(NUMBER, "fraction", "of all rows, by those that have ended and how far others are"),
    MEMBER(INTEGER, "rows_ended", NULL),
    MEMBER(INTEGER, "rows_expected", "an estimate for a bisection that runs"),
    MEMBER_OR_NULL(NUMBER, "eta_seconds", "expected until the end"),
    MEMBER_END,
};

static const struct json_field forecast_members[] = {
    MEMBER(INTEGER, "rows", "jobs; for a bisection, at most"),
    MEMBER(INTEGER, "reused", "rows whose result is there"),
    MEMBER(NUMBER, "steps", "of all jobs to be run"),
    MEMBER(NUMBER, "memory_bytes", "of the largest job"),
    MEMBER(NUMBER, "disk_bytes", "of all jobs to be run"),
    {.key = "wall_seconds",
     .kind = FIELD_OBJECT,
     .fields = schema_seconds_interval,
     .meaning = "of all jobs to be run, one after another"},
    {.key = "elapsed_seconds",
     .kind = FIELD_OBJECT,
     .fields = schema_seconds_interval,
     .meaning = "with as many at once as this service runs"},
    MEMBER_END,
};
const struct json_field schema_study_forecast = {
    .kind = FIELD_OBJECT, .schema = "StudyForecast", .fields = forecast_members};

static const struct json_field search_members[] = {
    MEMBER_OR_NULL(NUMBER, "value", "the end of the bracket that meets the condition; null: none"),
    MEMBER(NUMBER, "low", NULL),
    MEMBER(NUMBER, "high", NULL),
    MEMBER_SOMETIMES(TEXT, "detail", "why there is no value"),
    {.key = "parameters",
     .kind = FIELD_MAP,
     .optional = true,
     .item = &anything,
     .meaning = "of for_each"},
    MEMBER_END,
};
static const struct json_field search_item = {
    .kind = FIELD_OBJECT, .schema = "StudySearch", .fields = search_members};

static const struct json_field result_members[] = {
    MEMBER_SOMETIMES(NUMBER, "value", "the end of the bracket that meets the condition"),
    MEMBER_SOMETIMES(NUMBER, "low", NULL),
    MEMBER_SOMETIMES(NUMBER, "high", NULL),
    {.key = "for_each",
     .kind = FIELD_LIST,
     .optional = true,
     .item = &search_item,
     .meaning = "one for each repetition, instead of the others"},
    MEMBER_END,
};

static const struct json_field link_members[] = {
    MEMBER(TEXT, "self", NULL),
    MEMBER(TEXT, "results", NULL),
    MEMBER(TEXT, "chart", NULL),
    MEMBER(TEXT, "events", NULL),
    MEMBER(TEXT, "cancel", NULL),
    MEMBER(TEXT, "jobs", NULL),
    MEMBER_END,
};

static const struct json_field text_item = {.kind = FIELD_TEXT};

static const struct json_field study_members[] = {
    MEMBER(TEXT, "id", "sortable, URL-safe"),
    MEMBER(TEXT, "name", "for people"),
    MEMBER(TEXT, "kind", "of the design"),
    {.key = "state",
     .kind = FIELD_TEXT,
     .words = study_state_words,
     .meaning = "where it is between submission and end"},
    MEMBER_OR_NULL(TEXT, "detail", "why it failed"),
    MEMBER_OR_NULL(TEXT, "owner", "name of the token that submitted it"),
    MEMBER(BOOLEAN, "cancel_requested", "it runs until the processes of its jobs are gone"),
    MEMBER(INTEGER, "revision", "changes with everything but progress"),
    MEMBER(TEXT, "created_at", "RFC 3339"),
    MEMBER_OR_NULL(TEXT, "finished_at", "RFC 3339"),
    {.key = "counts", .kind = FIELD_OBJECT, .fields = count_members, .meaning = "rows by state"},
    {.key = "progress",
     .kind = FIELD_OBJECT,
     .fields = progress_members,
     .meaning = "how far its rows are"},
    {.key = "parameters", .kind = FIELD_LIST, .item = &text_item, .meaning = "of a row"},
    {.key = "metrics", .kind = FIELD_LIST, .item = &text_item, .meaning = "of a row"},
    {.key = "chart",
     .kind = FIELD_OBJECT,
     .nullable = true,
     .fields = chart_fields,
     .meaning = "what chart.svg draws"},
    MEMBER(BOOLEAN, "reuse", "finished jobs of the same scene are used"),
    {.key = "forecast",
     .kind = FIELD_SAME,
     .nullable = true,
     .item = &schema_study_forecast,
     .meaning = "as it was at submission"},
    {.key = "advice",
     .kind = FIELD_LIST,
     .item = &schema_advice,
     .meaning = "about the scene of the first row"},
    {.key = "result",
     .kind = FIELD_OBJECT,
     .nullable = true,
     .fields = result_members,
     .meaning = "of a bisection"},
    {.key = "links",
     .kind = FIELD_OBJECT,
     .fields = link_members,
     .meaning = "where its parts are"},
    MEMBER_SOMETIMES(ANY, "scene", "as sent; not in lists"),
    MEMBER_SOMETIMES(ANY, "design", "as sent; not in lists"),
    MEMBER_END,
};
const struct json_field schema_study = {
    .kind = FIELD_OBJECT, .schema = "Study", .fields = study_members};

static const struct json_field list_members[] = {
    {.key = "studies", .kind = FIELD_LIST, .item = &schema_study},
    MEMBER_OR_NULL(TEXT, "cursor", "of the next page; null at the end"),
    MEMBER_END,
};
const struct json_field schema_study_list = {
    .kind = FIELD_OBJECT, .schema = "StudyList", .fields = list_members};

static const struct json_field metric_value = {.kind = FIELD_NUMBER, .nullable = true};

static const struct json_field row_members[] = {
    MEMBER(INTEGER, "row", "number, from 0"),
    {.key = "state", .kind = FIELD_TEXT, .words = row_state_words},
    MEMBER_OR_NULL(TEXT, "job", "id; null before it is one and after it was deleted"),
    MEMBER_OR_NULL(TEXT, "reason", "of a failure"),
    MEMBER_OR_NULL(TEXT, "detail", "of a failure"),
    MEMBER(BOOLEAN, "reused", "the job was there before the study"),
    {.key = "parameters", .kind = FIELD_MAP, .item = &anything},
    {.key = "metrics", .kind = FIELD_MAP, .item = &metric_value, .meaning = "null: none"},
    MEMBER_END,
};
static const struct json_field row_item = {
    .kind = FIELD_OBJECT, .schema = "StudyRow", .fields = row_members};

static const struct json_field results_members[] = {
    MEMBER(TEXT, "study", "id"),
    {.key = "state", .kind = FIELD_TEXT, .words = study_state_words},
    {.key = "parameters", .kind = FIELD_LIST, .item = &text_item, .meaning = "columns"},
    {.key = "metrics", .kind = FIELD_LIST, .item = &text_item, .meaning = "columns"},
    {.key = "rows", .kind = FIELD_LIST, .item = &row_item},
    MEMBER_END,
};
const struct json_field schema_study_results = {
    .kind = FIELD_OBJECT, .schema = "StudyResults", .fields = results_members};

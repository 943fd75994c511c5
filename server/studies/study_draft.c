/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_draft.h"

#include "reply.h"
#include "schemas.h"
#include "studies/study_metric.h"
#include "submission.h"

#include <stdio.h>
#include <string.h>

bool study_draft_is(const json_t *body)
{
    return json_object_get(body, "design") != NULL;
}

/* Keeps what the jobs get as it was sent. */
static void options_keep(const json_t *body, struct study_draft *draft, json_t *errors)
{
    static const char *const shared[] = {"labels", "priority", "threads", "limits", "retries"};
    struct talus_error error = {0};
    json_t *options = json_object();
    for (size_t index = 0; index < sizeof shared / sizeof shared[0]; index++) {
        json_t *value = json_object_get(body, shared[index]);
        if (value != NULL)
            (void)json_object_set(options, shared[index], value);
    }
    if (job_json_set(&draft->study.options, options, &error) != TALUS_OK)
        issue_add(errors, "", "memory", NULL, NULL, "out of memory");
    json_decref(options);
}

/* Reads what the body shares with that of a job. */
static void shared_read(const json_t *body, int64_t workers, struct study_draft *draft,
                        json_t *errors)
{
    struct job job = {0};
    json_fields_read(schema_study_submission.fields, body, "", &job, errors);
    submission_threads_check(body, job.threads, workers, errors);
    if (job.name != NULL && job.name[0] == '\0')
        issue_add(errors, "/name", "length", NULL, NULL, "a name is wanted");
    draft->threads = job.threads;
    draft->study.name = job.name;
    job.name = NULL;
    job_release(&job);
    draft->study.reuse = !json_is_false(json_object_get(body, "reuse"));
    options_keep(body, draft, errors);
}

static bool listed(const json_t *list, const char *name)
{
    size_t index;
    const json_t *item;
    json_array_foreach(list, index, item)
    {
        if (json_is_string(item) && strcmp(json_string_value(item), name) == 0)
            return true;
    }
    return false;
}

/* Adds a metric that the study needs to know of its jobs. */
static void wanted_add(struct study_draft *draft, const char *name)
{
    if (name != NULL && !listed(draft->wanted, name))
        (void)json_array_append_new(draft->wanted, json_string(name));
}

static void metrics_read(const json_t *body, struct study_draft *draft, json_t *errors)
{
    const json_t *metrics = json_object_get(body, "metrics");
    struct talus_error error = {0};
    size_t index;
    const json_t *name;
    json_array_foreach(metrics, index, name)
    {
        char pointer[32];
        (void)snprintf(pointer, sizeof pointer, "/metrics/%zu", index);
        if (json_is_string(name) && listed(draft->wanted, json_string_value(name)))
            issue_add(errors, pointer, "repeated", name, NULL, "this metric is named twice");
        else if (json_is_string(name))
            wanted_add(draft, json_string_value(name));
    }
    if (job_json_set(&draft->study.metrics, metrics, &error) != TALUS_OK)
        issue_add(errors, "/metrics", "memory", NULL, NULL, "out of memory");
}

/* One axis of a chart: a parameter or a metric. */
static void axis_read(const json_t *chart, const char *key, struct study_draft *draft,
                      json_t *errors)
{
    const json_t *value = json_object_get(chart, key);
    const char *name = json_string_value(value);
    char pointer[32];
    (void)snprintf(pointer, sizeof pointer, "/chart/%s", key);
    if (name == NULL || listed(draft->plan.names, name))
        return;
    if (!study_metric_like(name))
        issue_add(errors, pointer, "unknown_value", value, draft->plan.names,
                  "this is no parameter of the design and no metric");
    else
        wanted_add(draft, name);
}

/* Names of axes, together or in a list. */
static bool log_holds(const json_t *log)
{
    size_t index;
    const json_t *axis;
    if (log == NULL || json_is_boolean(log))
        return true;
    if (json_is_string(log))
        return json_string_length(log) > 0 &&
               strspn(json_string_value(log), "xyz") == json_string_length(log);
    bool good = json_is_array(log);
    json_array_foreach(log, index, axis)
    {
        good = good && json_is_string(axis) && json_string_length(axis) == 1 && log_holds(axis);
    }
    return good;
}

static void chart_read(const json_t *body, struct study_draft *draft, json_t *errors)
{
    const json_t *chart = json_object_get(body, "chart");
    struct talus_error error = {0};
    axis_read(chart, "x", draft, errors);
    axis_read(chart, "y", draft, errors);
    axis_read(chart, "z", draft, errors);
    axis_read(chart, "series", draft, errors);
    if (json_is_object(chart) && !log_holds(json_object_get(chart, "log")))
        issue_add(errors, "/chart/log", "type", json_object_get(chart, "log"), NULL,
                  "true, false, \"x\", \"y\", \"xy\" or a list of axes is wanted");
    if (job_json_set(&draft->study.chart, chart, &error) != TALUS_OK)
        issue_add(errors, "/chart", "memory", NULL, NULL, "out of memory");
}

/* What the design itself needs to know of its jobs. */
static void design_wants(struct study_draft *draft)
{
    const struct condition *condition = &draft->plan.bisect.condition;
    wanted_add(draft, draft->plan.error_metric);
    wanted_add(draft, draft->plan.cost_metric);
    for (size_t index = 0; draft->plan.kind == STUDY_BISECT && index < condition->term_count;
         index++)
        wanted_add(draft, condition->terms[index].metric);
}

/* What a bisection runs first: the ends of every search. */
static json_t *bisection_ends(const struct study_plan *plan)
{
    json_t *rows = json_array();
    size_t index;
    const json_t *repeated;
    json_array_foreach(plan->rows, index, repeated)
    {
        (void)json_array_append_new(rows, study_bisect_row(plan, repeated, plan->bisect.low));
        (void)json_array_append_new(rows, study_bisect_row(plan, repeated, plan->bisect.high));
    }
    return rows;
}

static void design_read(const json_t *body, const struct config *config, struct study_draft *draft,
                        json_t *errors)
{
    const json_t *design = json_object_get(body, "design");
    struct study *study = &draft->study;
    struct talus_error error = {0};
    if (draft->scene == NULL || !json_is_object(design))
        return;
    if (!study_plan_read(draft->scene, design, (size_t)config->study_rows, &draft->plan, errors))
        return;
    study->kind = draft->plan.kind;
    study->rows_expected = (int64_t)study_plan_count(&draft->plan);
    draft->rows = draft->plan.kind == STUDY_BISECT ? bisection_ends(&draft->plan)
                                                   : json_incref(draft->plan.rows);
    if (job_json_set(&study->scene, draft->scene, &error) != TALUS_OK ||
        job_json_set(&study->design, design, &error) != TALUS_OK ||
        job_json_set(&study->names, draft->plan.names, &error) != TALUS_OK)
        issue_add(errors, "", "memory", NULL, NULL, "out of memory");
}

void study_draft_read(const json_t *body, const struct config *config, struct study_draft *draft,
                      json_t *errors)
{
    struct talus_error error = {0};
    draft->wanted = json_array();
    if (!json_is_object(body)) {
        issue_add(errors, "", "type", NULL, NULL, "the body must be an object");
        return;
    }
    draft->scene = json_object_get(body, "scene");
    shared_read(body, (int64_t)config->workers, draft, errors);
    metrics_read(body, draft, errors);
    design_read(body, config, draft, errors);
    if (json_array_size(errors) > 0)
        return;
    chart_read(body, draft, errors);
    design_wants(draft);
    draft->study.revision = 1;
    if (job_json_set(&draft->study.wanted, draft->wanted, &error) != TALUS_OK)
        issue_add(errors, "", "memory", NULL, NULL, "out of memory");
}

json_t *study_draft_forecast(const struct study_draft *draft)
{
    return json_pack("{s:o, s:O*, s:[]}", "forecast", json_loads(draft->study.forecast, 0, NULL),
                     "advice", draft->advice, "warnings");
}

void study_draft_release(struct study_draft *draft)
{
    study_release(&draft->study);
    study_plan_release(&draft->plan);
    json_decref(draft->rows);
    json_decref(draft->wanted);
    json_decref(draft->advice);
    memset(draft, 0, sizeof *draft);
}

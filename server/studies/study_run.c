/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_run.h"

#include "jobs.h"
#include "studies/study_life.h"
#include "studies/study_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct study_run *study_run_create(void)
{
    return calloc(1, sizeof(struct study_run));
}

void study_run_destroy(struct study_run *run)
{
    study_release(&run->study);
    json_decref(run->scene);
    json_decref(run->options);
    free(run);
}

/* The trials of a bisection. */
struct trials {
    const struct study_bisect *bisect;
    struct bisect_trial *items;
    size_t count, capacity;
    char detail[256]; /* why the study cannot go on, or empty */
};

/* The value that a row tries: the only one it sets. */
static double trial_value(const struct study_row *row)
{
    json_t *settings = json_loads(row->settings, 0, NULL);
    double value = json_number_value(json_object_iter_value(json_object_iter(settings)));
    json_decref(settings);
    return value;
}

static bool trial_note(const struct study_row *row, void *context)
{
    struct trials *trials = context;
    const char *missing = NULL;
    json_t *metrics = row->metrics == NULL ? json_object() : json_loads(row->metrics, 0, NULL);
    enum condition_answer answer =
        row->state == ROW_SUCCEEDED
            ? condition_evaluate(&trials->bisect->condition, metrics, &missing)
            : CONDITION_NOT_MET;
    if (row->state == ROW_CANCELLED)
        (void)snprintf(trials->detail, sizeof trials->detail, "the job of row %lld was cancelled",
                       (long long)row->number);
    if (answer == CONDITION_NO_METRIC)
        (void)snprintf(trials->detail, sizeof trials->detail,
                       "the job of row %lld has no metric %s", (long long)row->number, missing);
    if (trials->count < trials->capacity)
        trials->items[trials->count++] =
            (struct bisect_trial){.value = trial_value(row), .met = answer == CONDITION_MET};
    json_decref(metrics);
    return true;
}

static enum talus_status trials_read(const struct study *study, struct service *service,
                                     struct trials *trials, struct talus_error *error)
{
    const struct row_filter filter = {.state = ROW_STATE_COUNT};
    trials->capacity = (size_t)study->row_count;
    trials->items = calloc(trials->capacity + 1, sizeof *trials->items);
    if (trials->items == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory");
    return study_store_rows(service->store, study->id, &filter, trial_note, trials, error);
}

static enum talus_status bisect_extend(const struct study *study, const struct study_bisect *bisect,
                                       const struct bisect_step *step, struct service *service,
                                       struct talus_error *error)
{
    json_t *rows = json_array();
    for (size_t index = 0; index < step->run_count; index++)
        (void)json_array_append_new(rows, study_bisect_row(bisect, step->run[index]));
    enum talus_status status = study_extend(service, study->id, rows, error);
    json_decref(rows);
    return status;
}

static enum talus_status bisect_finish(const struct study *study, const struct bisect_step *step,
                                       struct service *service, struct talus_error *error)
{
    char *text = NULL;
    json_t *result =
        json_pack("{s:f, s:f, s:f}", "value", step->value, "low", step->low, "high", step->high);
    enum talus_status status = job_json_set(&text, result, error);
    if (status == TALUS_OK)
        status = study_end(service, study->id, STUDY_FINISHED, NULL, text, error);
    json_decref(result);
    free(text);
    return status;
}

static enum talus_status bisect_settle(const struct study *study, struct service *service,
                                       struct talus_error *error)
{
    struct study whole = {0};
    struct study_plan plan = {0};
    enum talus_status status = study_store_read(service->store, study->id, true, &whole, error);
    if (status != TALUS_OK)
        return status;
    json_t *scene = json_loads(whole.scene, JSON_DECODE_ANY, NULL);
    json_t *design = json_loads(whole.design, JSON_DECODE_ANY, NULL);
    json_t *errors = json_array();
    struct trials trials = {.bisect = &plan.bisect};
    if (!study_plan_read(scene, design, (size_t)service->config->study_rows, &plan, errors))
        (void)snprintf(trials.detail, sizeof trials.detail,
                       "this version of talusd does not take the design");
    else
        status = trials_read(study, service, &trials, error);
    if (status == TALUS_OK && trials.detail[0] != '\0') {
        status = study_end(service, study->id, STUDY_FAILED, trials.detail, NULL, error);
    } else if (status == TALUS_OK) {
        struct bisect_step step = study_bisect_next(&plan.bisect, trials.items, trials.count);
        if (step.state == BISECT_RUN)
            status = bisect_extend(study, &plan.bisect, &step, service, error);
        else if (step.state == BISECT_DONE)
            status = bisect_finish(study, &step, service, error);
        else
            status = study_end(service, study->id, STUDY_FAILED, step.detail, NULL, error);
    }
    free(trials.items);
    study_plan_release(&plan);
    study_release(&whole);
    json_decref(scene);
    json_decref(design);
    json_decref(errors);
    return status;
}

enum talus_status study_run_settle(struct study_run *run, struct service *service,
                                   struct talus_error *error)
{
    const struct study *study = &run->study;
    if (study->cancel_requested)
        return study_end(service, study->id, STUDY_CANCELLED, NULL, NULL, error);
    if (study->kind == STUDY_BISECT)
        return bisect_settle(study, service, error);
    return study_end(service, study->id, STUDY_FINISHED, NULL, NULL, error);
}

static bool job_note(const struct study_row *row, void *context)
{
    return row->job == NULL || json_array_append_new(context, json_string(row->job)) == 0;
}

enum talus_status study_run_stop(struct study_run *run, struct service *service,
                                 struct talus_error *error)
{
    static const enum row_state active[] = {ROW_QUEUED, ROW_RUNNING};
    enum talus_status status = TALUS_OK;
    size_t index;
    const json_t *id;
    if (run->stopped)
        return TALUS_OK;
    json_t *jobs = json_array();
    for (size_t state = 0; state < 2 && status == TALUS_OK; state++) {
        const struct row_filter filter = {.state = active[state]};
        status = study_store_rows(service->store, run->study.id, &filter, job_note, jobs, error);
    }
    json_array_foreach(jobs, index, id)
    {
        struct job job = {0};
        struct talus_error own = {0};
        if (status != TALUS_OK)
            break;
        /* One that has ended meanwhile has ended. */
        enum talus_status done = jobs_cancel(service, json_string_value(id), -1, &job, &own);
        if (done != TALUS_OK && strcmp(own.code, "state") != 0 &&
            strcmp(own.code, "not_found") != 0)
            status = talus_error_set(error, done, own.code, "", "%s", own.text);
        job_release(&job);
    }
    run->stopped = status == TALUS_OK;
    json_decref(jobs);
    return status;
}

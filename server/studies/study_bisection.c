/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_bisection.h"

#include "json_text.h"
#include "studies/study_life.h"
#include "studies/study_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The trials of one search, in the order of their rows. */
struct search {
    struct bisect_trial *trials;
    size_t count, capacity;
};

/* Everything that a settlement reads and makes. Owned, but for the service. */
struct bisection {
    struct service *service;
    struct study study;
    struct study_plan plan;
    json_t *scene;
    json_t *places; /* what a search is repeated for, as text -> its number */
    struct search *searches;
    size_t search_count;
    char detail[256]; /* why the study cannot go on, or empty */
    bool failed;      /* no memory */
};

/* What names a search: the parameters of its rows but the one it varies. */
static char *search_name(const json_t *parameters, const char *varied)
{
    json_t *others = json_copy((json_t *)(uintptr_t)parameters);
    (void)json_object_del(others, varied);
    char *name = json_dumps(others, JSON_COMPACT | JSON_SORT_KEYS);
    json_decref(others);
    return name;
}

static enum talus_status searches_prepare(struct bisection *bisection, struct talus_error *error)
{
    const struct study_plan *plan = &bisection->plan;
    size_t index;
    const json_t *repeated;
    bool good = true;
    bisection->search_count = json_array_size(plan->rows);
    bisection->searches = calloc(bisection->search_count + 1, sizeof *bisection->searches);
    bisection->places = json_object();
    json_array_foreach(plan->rows, index, repeated)
    {
        char *name = search_name(json_object_get(repeated, "parameters"), plan->bisect.parameter);
        good = good && name != NULL &&
               json_object_set_new(bisection->places, name, json_integer((json_int_t)index)) == 0;
        free(name);
    }
    return good && bisection->searches != NULL ? TALUS_OK : talus_error_memory(error);
}

static bool trial_add(struct search *search, struct bisect_trial trial)
{
    if (search->count == search->capacity) {
        size_t capacity = search->capacity == 0 ? 16 : 2 * search->capacity;
        struct bisect_trial *trials = realloc(search->trials, capacity * sizeof *trials);
        if (trials == NULL)
            return false;
        search->trials = trials;
        search->capacity = capacity;
    }
    search->trials[search->count++] = trial;
    return true;
}

static bool trial_met(struct bisection *bisection, const struct study_row *row)
{
    const char *missing = NULL;
    json_t *metrics = row->metrics == NULL ? json_object() : json_loads(row->metrics, 0, NULL);
    enum condition_answer answer =
        row->state == ROW_SUCCEEDED
            ? condition_evaluate(&bisection->plan.bisect.condition, metrics, &missing)
            : CONDITION_NOT_MET;
    if (row->reason != NULL && strcmp(row->reason, "invalid") == 0)
        (void)snprintf(bisection->detail, sizeof bisection->detail, "row %lld: %s",
                       (long long)row->number, row->detail == NULL ? "" : row->detail);
    if (row->state == ROW_CANCELLED)
        (void)snprintf(bisection->detail, sizeof bisection->detail,
                       "the job of row %lld was cancelled", (long long)row->number);
    if (answer == CONDITION_NO_METRIC)
        (void)snprintf(bisection->detail, sizeof bisection->detail,
                       "the job of row %lld has no metric %s", (long long)row->number, missing);
    json_decref(metrics);
    return answer == CONDITION_MET;
}

static bool trial_note(const struct study_row *row, void *context)
{
    struct bisection *bisection = context;
    const char *varied = bisection->plan.bisect.parameter;
    json_t *parameters = json_loads(row->parameters, 0, NULL);
    char *name = search_name(parameters, varied);
    const json_t *place = name == NULL ? NULL : json_object_get(bisection->places, name);
    const struct bisect_trial trial = {.value =
                                           json_number_value(json_object_get(parameters, varied)),
                                       .met = trial_met(bisection, row)};
    if (place != NULL)
        bisection->failed =
            bisection->failed || !trial_add(&bisection->searches[json_integer_value(place)], trial);
    bisection->failed = bisection->failed || name == NULL;
    free(name);
    json_decref(parameters);
    return !bisection->failed;
}

static enum talus_status bisection_read(struct bisection *bisection, const char *id,
                                        struct talus_error *error)
{
    const struct row_filter every = {.state = ROW_STATE_COUNT};
    struct service *service = bisection->service;
    enum talus_status status = study_store_read(service->store, id, true, &bisection->study, error);
    if (status != TALUS_OK)
        return status;
    bisection->scene = json_loads(bisection->study.scene, JSON_DECODE_ANY, NULL);
    json_t *design = json_loads(bisection->study.design, JSON_DECODE_ANY, NULL);
    json_t *errors = json_array();
    bool taken = study_plan_read(bisection->scene, design, (size_t)service->config->study_rows,
                                 &bisection->plan, errors);
    json_decref(errors);
    json_decref(design);
    if (!taken) {
        (void)snprintf(bisection->detail, sizeof bisection->detail,
                       "this version of talusd does not take the design");
        return TALUS_OK;
    }
    status = searches_prepare(bisection, error);
    if (status == TALUS_OK)
        status = study_store_rows(service->store, id, &every, trial_note, bisection, error);
    return status == TALUS_OK && bisection->failed ? talus_error_memory(error) : status;
}

static void bisection_release(struct bisection *bisection)
{
    for (size_t index = 0; bisection->searches != NULL && index < bisection->search_count; index++)
        free(bisection->searches[index].trials);
    free(bisection->searches);
    study_plan_release(&bisection->plan);
    study_release(&bisection->study);
    json_decref(bisection->scene);
    json_decref(bisection->places);
}

static json_t *step_result(const struct bisect_step *step)
{
    if (step->state == BISECT_FAILED)
        return json_pack("{s:n, s:f, s:f, s:s}", "value", "low", step->low, "high", step->high,
                         "detail", step->detail);
    return json_pack("{s:f, s:f, s:f}", "value", step->value, "low", step->low, "high", step->high);
}

/* The one search's result, or all with what they were repeated for. */
static json_t *whole_result(const struct bisection *bisection, const struct bisect_step *steps)
{
    const json_t *design = json_object_get(bisection->plan.design, "bisect");
    if (json_object_get(design, "for_each") == NULL)
        return step_result(&steps[0]);
    json_t *list = json_array();
    for (size_t index = 0; index < bisection->search_count; index++) {
        json_t *one = step_result(&steps[index]);
        (void)json_object_set(
            one, "parameters",
            json_object_get(json_array_get(bisection->plan.rows, index), "parameters"));
        (void)json_array_append_new(list, one);
    }
    return json_pack("{s:o}", "for_each", list);
}

static enum talus_status bisection_finish(const struct bisection *bisection,
                                          const struct bisect_step *steps,
                                          struct talus_error *error)
{
    const char *id = bisection->study.id;
    char *text = NULL;
    bool found = false;
    for (size_t index = 0; index < bisection->search_count; index++)
        found = found || steps[index].state == BISECT_DONE;
    if (!found)
        return study_end(bisection->service, id, STUDY_FAILED, steps[0].detail, NULL, error);
    json_t *result = whole_result(bisection, steps);
    enum talus_status status = job_json_set(&text, result, error);
    if (status == TALUS_OK)
        status = study_end(bisection->service, id, STUDY_FINISHED, NULL, text, error);
    json_decref(result);
    free(text);
    return status;
}

static enum talus_status searches_step(const struct bisection *bisection, struct bisect_step *steps,
                                       struct talus_error *error)
{
    const struct study_plan *plan = &bisection->plan;
    json_t *rows = json_array();
    for (size_t index = 0; index < bisection->search_count; index++) {
        const struct search *search = &bisection->searches[index];
        steps[index] = study_bisect_next(&plan->bisect, search->trials, search->count);
        for (size_t run = 0; steps[index].state == BISECT_RUN && run < steps[index].run_count;
             run++)
            (void)json_array_append_new(
                rows,
                study_bisect_row(plan, json_array_get(plan->rows, index), steps[index].run[run]));
    }
    enum talus_status status =
        json_array_size(rows) > 0
            ? study_extend(bisection->service, bisection->study.id, rows, error)
            : bisection_finish(bisection, steps, error);
    json_decref(rows);
    return status;
}

enum talus_status study_bisection_settle(const struct study *study, struct service *service,
                                         struct talus_error *error)
{
    struct bisection bisection = {.service = service};
    struct bisect_step *steps = NULL;
    enum talus_status status = bisection_read(&bisection, study->id, error);
    if (status == TALUS_OK && bisection.detail[0] != '\0') {
        status = study_end(service, study->id, STUDY_FAILED, bisection.detail, NULL, error);
    } else if (status == TALUS_OK) {
        steps = calloc(bisection.search_count + 1, sizeof *steps);
        status =
            steps == NULL ? talus_error_memory(error) : searches_step(&bisection, steps, error);
    }
    free(steps);
    bisection_release(&bisection);
    return status;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* A row that waits becomes a job, shows one that is there, or fails. */
#include "folder.h"
#include "jobs.h"
#include "scene_question.h"
#include "studies/study_run.h"
#include "studies/study_store.h"
#include "submission.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* So often may a helper die over a row before the row is to blame. */
enum { HELPER_FAILURES_MAX = 3 };

struct row_task {
    struct study_run *run;
    struct service *service;
    int64_t number;
    json_t *settings, *answer; /* owned */
};

static bool task_note(const struct study_row *row, void *context)
{
    struct row_task *task = context;
    task->number = row->number;
    task->settings = json_loads(row->settings, 0, NULL);
    return false;
}

/* Parses what all rows have in common, once. */
static bool run_load(struct study_run *run, struct service *service)
{
    struct study whole = {0};
    struct talus_error error = {0};
    if (run->scene != NULL)
        return true;
    if (study_store_read(service->store, run->study.id, true, &whole, &error) != TALUS_OK)
        return false;
    run->scene = json_loads(whole.scene, JSON_DECODE_ANY, NULL);
    run->options = json_loads(whole.options == NULL ? "{}" : whole.options, 0, NULL);
    study_release(&whole);
    return run->scene != NULL && run->options != NULL;
}

static enum row_start row_finish(const struct row_task *task, const struct row_end *end)
{
    struct talus_error error = {0};
    enum talus_status status = study_store_row_end(task->service->store, end, &error);
    if (status == TALUS_OK || strcmp(error.code, "state") == 0)
        return ROW_STARTED;
    (void)fprintf(stderr, "talusd: study %s: %s\n", end->study, error.text);
    return ROW_NOT_NOW;
}

/* The row fails without a job: its scene, which was good when the study was accepted, is not any
 * more. */
static enum row_start row_fail(const struct row_task *task, const char *detail)
{
    const struct row_end end = {.study = task->run->study.id,
                                .number = task->number,
                                .state = ROW_FAILED,
                                .reason = "invalid",
                                .detail = detail};
    return row_finish(task, &end);
}

static enum row_start row_refuse(const struct row_task *task)
{
    char detail[512];
    const json_t *first = json_array_get(json_object_get(task->answer, "errors"), 0);
    const char *pointer = json_string_value(json_object_get(first, "pointer"));
    const char *text = json_string_value(json_object_get(first, "detail"));
    (void)snprintf(detail, sizeof detail, "the scene is refused: %s: %s",
                   pointer == NULL ? "" : pointer, text == NULL ? "" : text);
    return row_fail(task, detail);
}

/* A finished job of the same scene and solver; *found tells whether there is one. */
static enum row_start row_reuse(const struct row_task *task, bool *found)
{
    struct store *store = task->service->store;
    struct talus_error error = {0};
    struct job job = {0};
    char id[64] = "";
    const char *hash = json_string_value(json_object_get(task->answer, "hash"));
    const char *build = json_string_value(json_object_get(task->answer, "build"));
    *found = false;
    if (!task->run->study.reuse || hash == NULL || build == NULL)
        return ROW_STARTED;
    if (store_job_find_finished(store, hash, build, id, &error) != TALUS_OK)
        return ROW_NOT_NOW;
    if (id[0] == '\0' || store_job_read(store, id, &job, &error) != TALUS_OK)
        return ROW_STARTED;
    const struct row_end end = {.study = task->run->study.id,
                                .number = task->number,
                                .state = ROW_SUCCEEDED,
                                .job = job.id,
                                .metrics = job.metrics};
    *found = true;
    enum row_start start = row_finish(task, &end);
    job_release(&job);
    return start;
}

static bool disk_fits(const struct row_task *task)
{
    const double free_bytes = folder_free_bytes(task->service->state);
    const json_t *forecast = json_object_get(task->answer, "forecast");
    double bytes = json_number_value(json_object_get(forecast, "disk_bytes"));
    return free_bytes < 0 || bytes <= free_bytes - task->service->config->disk_reserve_bytes;
}

static enum talus_status job_fill(const struct row_task *task, struct job *job,
                                  struct talus_error *error)
{
    const struct study *study = &task->run->study;
    const json_t *scene;
    char name[SUBMISSION_NAME_CHARACTERS + 1];
    json_t *errors = json_array();
    json_t *submission = json_copy(task->run->options);
    (void)json_object_set_new(submission, "scene", json_object());
    submission_read(submission, (int64_t)task->service->config->workers, job, &scene, errors);
    enum talus_status status =
        json_array_size(errors) > 0
            ? talus_error_set(
                  error, TALUS_INVALID, "options", "", "%s",
                  json_string_value(json_object_get(json_array_get(errors, 0), "detail")))
            : submission_answer_take(job, task->answer, task->service->config->workers, error);
    json_decref(submission);
    json_decref(errors);
    (void)snprintf(name, sizeof name, "%.200s [%lld]", study->name == NULL ? "" : study->name,
                   (long long)task->number);
    if (status == TALUS_OK)
        status = job_text_set(&job->name, name, error);
    if (status == TALUS_OK)
        status = job_text_set(&job->owner, study->owner, error);
    if (status == TALUS_OK)
        status = job_text_set(&job->study, study->id, error);
    job->study_row = task->number;
    return status;
}

static enum row_start row_submit(const struct row_task *task)
{
    struct talus_error error = {0};
    struct job job = {0};
    char existing[64];
    enum store_insert inserted;
    enum row_start start = ROW_STARTED;
    enum talus_status status = job_fill(task, &job, &error);
    if (status == TALUS_INVALID) {
        start = row_fail(task, error.text);
        status = TALUS_OK;
    } else if (status == TALUS_OK) {
        status = jobs_create(task->service, &job, json_object_get(task->answer, "effective"), NULL,
                             &inserted, existing, &error);
    }
    /* It was cancelled meanwhile. */
    if (status != TALUS_OK && strcmp(error.code, "state") != 0) {
        (void)fprintf(stderr, "talusd: study %s: row %lld: %s\n", task->run->study.id,
                      (long long)task->number, error.text);
        start = ROW_NOT_NOW;
    }
    job_release(&job);
    return start;
}

/* Asks about the scene; *asked is false if there is no answer, and the result says what of it. */
static enum row_start row_ask(struct row_task *task, struct helper *helper, bool *asked)
{
    struct study_run *run = task->run;
    struct talus_error error = {0};
    json_t *scene = study_scene(run->scene, task->settings);
    const json_t *threads = json_object_get(run->options, "threads");
    json_t *question =
        scene == NULL ? NULL
                      : scene_question(task->service, scene,
                                       threads == NULL ? 1 : (int64_t)json_number_value(threads));
    json_decref(scene);
    *asked = false;
    if (question == NULL)
        return row_fail(task, "the row cannot be put into the scene");
    enum talus_status status =
        helper_ask(helper, question, task->service->config->helper_seconds, &task->answer, &error);
    json_decref(question);
    *asked = status == TALUS_OK;
    if (status == TALUS_OK) {
        run->helper_failures = 0;
        return ROW_STARTED;
    }
    if (status != TALUS_LIMIT && ++run->helper_failures < HELPER_FAILURES_MAX)
        return ROW_NOT_NOW;
    run->helper_failures = 0;
    return row_fail(task, error.text);
}

static enum row_start row_start(struct row_task *task, struct helper *helper)
{
    bool done;
    enum row_start start = row_ask(task, helper, &done);
    if (!done)
        return start;
    if (!json_is_true(json_object_get(task->answer, "ok")))
        return row_refuse(task);
    start = row_reuse(task, &done);
    if (done || start != ROW_STARTED)
        return start;
    return disk_fits(task) ? row_submit(task) : ROW_NOT_NOW;
}

enum row_start study_run_start_row(struct study_run *run, struct service *service,
                                   struct helper *helper)
{
    const struct row_filter filter = {.state = ROW_WAITING, .limit = 1};
    struct talus_error error = {0};
    struct row_task task = {.run = run, .service = service};
    enum row_start start = ROW_NOT_NOW;
    if (run_load(run, service) && study_store_rows(service->store, run->study.id, &filter,
                                                   task_note, &task, &error) == TALUS_OK)
        start = task.settings == NULL ? ROW_NONE_LEFT : row_start(&task, helper);
    json_decref(task.settings);
    json_decref(task.answer);
    return start;
}

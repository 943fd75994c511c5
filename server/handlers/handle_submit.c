/* SPDX-License-Identifier: Apache-2.0 */
/* POST /v1/jobs and POST /v1/forecast: a scene is checked by a helper before it becomes a job. */
#include "admission.h"
#include "body.h"
#include "helper.h"
#include "job_reply.h"
#include "jobs.h"
#include "request.h"
#include "scene_question.h"
#include "schemas.h"
#include "studies/study_request.h"
#include "submission.h"
#include "supervisor.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* What a submission has become so far. */
struct submission {
    json_t *body, *answer, *errors;
    struct job job;
};

static void submission_release(struct submission *submission)
{
    json_decref(submission->body);
    json_decref(submission->answer);
    json_decref(submission->errors);
    job_release(&submission->job);
}

/* Asks the helper about the scene. False: the reply is made. */
static bool scene_check(struct request *request, struct submission *submission, const json_t *scene)
{
    struct talus_error error = {0};
    double seconds = request->service->config->helper_seconds;
    json_t *question = scene_question(request->service, scene, submission->job.threads);
    enum talus_status status = question == NULL ? talus_error_memory(&error)
                                                : helper_ask(request->helper, question, seconds,
                                                             &submission->answer, &error);
    json_decref(question);
    if (status == TALUS_LIMIT) {
        issue_add(submission->errors, "/scene", "too_costly", NULL, NULL, "%s", error.text);
    } else if (status != TALUS_OK) {
        reply_error(&request->reply, request->raw, &error);
        return false;
    } else if (!json_is_true(json_object_get(submission->answer, "ok"))) {
        admission_errors(submission->errors, json_object_get(submission->answer, "errors"),
                         "/scene");
        if (json_array_size(submission->errors) == 0)
            issue_add(submission->errors, "/scene", "invalid", NULL, NULL, "the scene is refused");
    }
    return true;
}

/* Reads the body and has the scene checked. False: the reply is made. */
static bool submission_check(struct request *request, struct submission *submission)
{
    const json_t *scene = NULL;
    struct talus_error error = {0};
    double workers = request->service->config->workers;
    submission->body = submission->body == NULL ? body_json(request) : submission->body;
    if (submission->body == NULL)
        return false;
    submission_read(submission->body, (int64_t)workers, &submission->job, &scene,
                    submission->errors);
    if (scene != NULL && !scene_check(request, submission, scene))
        return false;
    if (json_array_size(submission->errors) > 0) {
        admission_refused(request, submission->errors);
        return false;
    }
    if (submission_answer_take(&submission->job, submission->answer, workers, &error) != TALUS_OK) {
        reply_error(&request->reply, request->raw, &error);
        return false;
    }
    return true;
}

static void reply_job(struct request *request, unsigned int status, const struct job *job,
                      bool replayed)
{
    job_reply(request, status, job);
    admission_made(request, "/v1/jobs/", job->id, replayed);
}

static void reply_too_many(struct request *request, const char *code, const char *detail)
{
    char seconds[16];
    (void)snprintf(seconds, sizeof seconds, "%.0f",
                   ceil(supervisor_patience(request->service->supervisor)));
    reply_problem(&request->reply, MHD_HTTP_TOO_MANY_REQUESTS, code, request->raw, NULL, "%s",
                  detail);
    if (request->reply.response != NULL)
        (void)MHD_del_response_header(request->reply.response, MHD_HTTP_HEADER_RETRY_AFTER, "5");
    reply_header(&request->reply, MHD_HTTP_HEADER_RETRY_AFTER, seconds);
}

/* Answers for a key that is known, or a queue that is full. */
static void reply_known(struct request *request, const struct admission *admission)
{
    const enum store_insert known = admission->result;
    struct talus_error error = {0};
    struct job job = {0};
    if (known == STORE_OTHER_BODY) {
        admission_other_body(request);
    } else if (known == STORE_QUEUE_FULL) {
        reply_too_many(request, "queue_full", "as many jobs are queued as the daemon takes");
    } else if (known == STORE_QUOTA_QUEUED) {
        reply_too_many(request, "quota", "as many of your jobs are queued as you may have");
    } else if (known == STORE_QUOTA_DISK) {
        reply_too_many(request, "quota",
                       "with this job's results yours would take more disk than you may have; "
                       "delete some");
    } else if (store_job_read(request->service->store, admission->existing, &job, &error) ==
               TALUS_OK) {
        reply_job(request, MHD_HTTP_CREATED, &job, true);
        job_release(&job);
    } else {
        reply_error(&request->reply, request->raw, &error);
    }
}

/* Answers with a finished job of the same scene and solver, if that is asked for and there is one.
 * Nothing is made, so an Idempotency-Key is not kept. */
static bool reply_reused(struct request *request, const struct submission *submission)
{
    const json_t *build = json_object_get(submission->answer, "build");
    struct store *store = request->service->store;
    struct talus_error error = {0};
    struct job job = {0};
    char id[64];
    if (!submission_reuse(submission->body) || !json_is_string(build) ||
        store_job_find_finished(store, submission->job.scene_hash, json_string_value(build), id,
                                &error) != TALUS_OK ||
        id[0] == '\0' || store_job_read(store, id, &job, &error) != TALUS_OK)
        return false;
    bool good = job_text_set(&job.reused_from, id, &error) == TALUS_OK;
    if (good)
        reply_job(request, MHD_HTTP_OK, &job, false);
    job_release(&job);
    return good;
}

/* What the forecast says the results take. */
static double disk_bytes(const struct submission *submission)
{
    const json_t *forecast = json_object_get(submission->answer, "forecast");
    return json_number_value(json_object_get(forecast, "disk_bytes"));
}

static void submit(struct request *request, struct submission *submission)
{
    struct service *service = request->service;
    struct talus_error error = {0};
    struct admission admission;
    const struct store_key *key = &admission.key;
    submission->body = body_json(request);
    if (submission->body == NULL || !admission_key(request, submission->body, &admission))
        return;
    if (admission.result != STORE_INSERTED) {
        reply_known(request, &admission);
        return;
    }
    if (!submission_check(request, submission) || reply_reused(request, submission) ||
        !admission_disk(request, disk_bytes(submission)))
        return;
    const json_t *effective = json_object_get(submission->answer, "effective");
    if (job_text_set(&submission->job.owner, request->principal.name, &error) != TALUS_OK ||
        jobs_create(service, &submission->job, effective, key->key == NULL ? NULL : key,
                    &admission.result, admission.existing, &error) != TALUS_OK)
        reply_error(&request->reply, request->raw, &error);
    else if (admission.result != STORE_INSERTED)
        reply_known(request, &admission);
    else
        reply_job(request, MHD_HTTP_CREATED, &submission->job, false);
}

const struct operation operation_submit = {
    .summary = "Submits a job",
    .headers = admission_key_headers,
    .body = &schema_submission,
    .responses = (const struct response[]){{.status = 201,
                                            .type = "application/json",
                                            .schema = &schema_job,
                                            .headers = admission_made_headers,
                                            .meaning = "the job is on disk"},
                                           {.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_job,
                                            .headers = admission_made_headers,
                                            .meaning = "with reuse: a job whose result is there"},
                                           RESPONSE_END},
    .problems = (const unsigned int[]){429, 507, 0},
};

enum handled handle_submit(struct request *request)
{
    struct submission submission = {.errors = json_array()};
    if (!admission_draining(request))
        submit(request, &submission);
    submission_release(&submission);
    return HANDLED;
}

const struct operation operation_forecast = {
    .summary = "Checks a submission of a job or a study and says what it would take; makes nothing",
    .body = &schema_forecast_question,
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_forecast_answer,
                                            .meaning = "cost, advice, and the scene with every "
                                                       "default filled in"},
                                           RESPONSE_END},
};

static void study_forecast(struct request *request, const json_t *body)
{
    struct study_draft draft = {0};
    if (study_request_check(request, body, &draft))
        reply_json(&request->reply, MHD_HTTP_OK, study_draft_forecast(&draft));
    study_draft_release(&draft);
}

static void job_forecast(struct request *request, struct submission *submission)
{
    if (!submission_check(request, submission))
        return;
    const json_t *answer = submission->answer;
    json_t *reply = json_pack(
        "{s:O*, s:O*, s:O*, s:O*}", "forecast", json_object_get(answer, "forecast"), "advice",
        json_object_get(answer, "advice"), "warnings", json_object_get(answer, "warnings"),
        "effective_scene", json_object_get(answer, "effective"));
    reply_json(&request->reply, MHD_HTTP_OK, reply);
}

enum handled handle_forecast(struct request *request)
{
    struct submission submission = {.errors = json_array(), .body = body_json(request)};
    if (study_draft_is(submission.body))
        study_forecast(request, submission.body);
    else if (submission.body != NULL)
        job_forecast(request, &submission);
    submission_release(&submission);
    return HANDLED;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "submission.h"

#include "reply.h"
#include "schemas.h"

#include <math.h>
#include <string.h>

enum { LABELS_MAX = 64, DEFAULT_RETRIES = 2, THREADS_MAX = 4096 };

/* With `threads` 0 every so many particles get a thread: below that, threads cost more than they
 * give. */
static const double particles_per_thread = 20000;

/* `label=key:value` must stay unambiguous. */
static bool label_key_holds(const char *key)
{
    return strchr(key, ':') == NULL && strlen(key) <= SUBMISSION_NAME_CHARACTERS;
}

static const struct json_field label = {.kind = FIELD_TEXT, .most = SUBMISSION_NAME_CHARACTERS};

static const struct json_field limit_fields[] = {
    {.key = "wall_seconds",
     .kind = FIELD_NUMBER,
     .optional = true,
     .minimum = 1e-3,
     .maximum = 1e9,
     .offset = offsetof(struct job, wall_limit),
     .meaning = "over all attempts"},
    {.key = "memory_bytes",
     .kind = FIELD_INTEGER,
     .optional = true,
     .minimum = 1 << 20,
     .maximum = (double)(INT64_C(1) << 50),
     .offset = offsetof(struct job, memory_limit),
     .meaning = "of the worker"},
    {.key = "disk_bytes",
     .kind = FIELD_INTEGER,
     .optional = true,
     .minimum = 1 << 16,
     .maximum = (double)(INT64_C(1) << 50),
     .offset = offsetof(struct job, disk_limit),
     .meaning = "of the results"},
    {.key = NULL},
};

const struct json_field submission_labels = {.kind = FIELD_MAP,
                                             .most = LABELS_MAX,
                                             .item = &label,
                                             .key_pattern = "^[^:]{0,256}$",
                                             .key_holds = label_key_holds,
                                             .meaning = "for filters; no colon in a key"};
const struct json_field submission_limits = {
    .kind = FIELD_OBJECT, .fields = limit_fields, .meaning = "beyond which the job fails"};
const struct json_field submission_priority = {
    .kind = FIELD_INTEGER, .minimum = -100, .maximum = 100, .meaning = "larger ones start first"};
const struct json_field submission_threads = {
    .kind = FIELD_INTEGER,
    .minimum = 0,
    .maximum = THREADS_MAX,
    .preset = 1,
    .meaning = "that the job takes; 0: as many as the forecast says pay"};
const struct json_field submission_retries = {.kind = FIELD_INTEGER,
                                              .minimum = 0,
                                              .maximum = 100,
                                              .preset = DEFAULT_RETRIES,
                                              .meaning = "after crashes"};

static const struct json_field settings_fields[] = {SUBMISSION_SETTINGS, {.key = NULL}};

static const struct json_field submission_fields[] = {
    SUBMISSION_FIELDS(true),
    {.key = "reuse",
     .kind = FIELD_BOOLEAN,
     .optional = true,
     .offset = FIELD_NOWHERE,
     .meaning = "take the result of a finished job of the same scene and build, if there is one"},
    {.key = NULL},
};
const struct json_field schema_submission = {
    .kind = FIELD_OBJECT, .schema = "Submission", .fields = submission_fields};

void submission_settings_read(const json_t *body, struct job *job, json_t *errors)
{
    json_fields_read(settings_fields, body, "", job, errors);
}

void submission_threads_check(const json_t *body, int64_t threads, int64_t workers, json_t *errors)
{
    if (threads > workers)
        issue_add(errors, "/threads", "capacity", json_object_get(body, "threads"), NULL,
                  "this service runs %lld threads at once", (long long)workers);
}

void submission_read(const json_t *body, int64_t workers, struct job *job, const json_t **scene,
                     json_t *errors)
{
    *scene = json_object_get(body, "scene");
    if (!json_is_object(body)) {
        issue_add(errors, "", "type", NULL, NULL, "the body must be an object");
        return;
    }
    json_fields_read(submission_fields, body, "", job, errors);
    submission_threads_check(body, job->threads, workers, errors);
}

bool submission_reuse(const json_t *body)
{
    return json_is_true(json_object_get(body, "reuse"));
}

/* The number of threads that the forecast says pay. */
static int64_t threads_that_pay(const json_t *forecast, double workers)
{
    const json_t *threads = json_object_get(forecast, "threads");
    double wanted =
        json_is_number(threads)
            ? json_number_value(threads)
            : json_number_value(json_object_get(forecast, "particles")) / particles_per_thread;
    wanted = floor(wanted);
    return (int64_t)(wanted < 1 ? 1 : wanted > workers ? workers : wanted);
}

enum talus_status submission_answer_take(struct job *job, const json_t *answer, double workers,
                                         struct talus_error *error)
{
    const json_t *forecast = json_object_get(answer, "forecast");
    if (job->threads == 0)
        job->threads = threads_that_pay(forecast, workers);
    enum talus_status status = job_json_set(&job->forecast, forecast, error);
    if (status == TALUS_OK)
        status = job_json_set(&job->advice, json_object_get(answer, "advice"), error);
    if (status == TALUS_OK)
        status = job_json_set(&job->warnings, json_object_get(answer, "warnings"), error);
    if (status == TALUS_OK)
        status = job_text_set(&job->scene_hash, json_string_value(json_object_get(answer, "hash")),
                              error);
    return status;
}

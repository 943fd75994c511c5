/* SPDX-License-Identifier: Apache-2.0 */
#include "job_patch.h"

#include "reply.h"
#include "schemas.h"
#include "submission.h"

#include <stdlib.h>
#include <string.h>

static const char *const looks[] = {"checkpoint_now", "frame_now"};
enum { LOOK_COUNT = sizeof looks / sizeof looks[0] };

/* Merges the member `key` of a patch into an object of the job's. */
static void member_merge(json_t *settings, const json_t *body, const char *key)
{
    json_t *patch = json_object_get(body, key), *value;
    json_t *object = json_object_get(settings, key);
    const char *name;
    if (json_is_null(patch)) {
        (void)json_object_clear(object);
    } else if (patch != NULL && !json_is_object(patch)) {
        (void)json_object_set(settings, key, patch);
    } else {
        json_object_foreach(patch, name, value)
        {
            if (json_is_null(value))
                (void)json_object_del(object, name);
            else
                (void)json_object_set(object, name, value);
        }
    }
}

/* Priority, labels and limits of a job after a patch, as a submission has them; new reference. */
static json_t *settings_merge(const struct job *job, const json_t *body)
{
    json_t *priority = json_object_get(body, "priority");
    json_t *labels = json_loads(job->labels == NULL ? "{}" : job->labels, 0, NULL);
    json_t *settings = json_pack("{s:I, s:o, s:o}", "priority", (json_int_t)job->priority, "labels",
                                 labels, "limits", job_limits_json(job));
    member_merge(settings, body, "labels");
    member_merge(settings, body, "limits");
    if (json_is_null(priority))
        (void)json_object_del(settings, "priority");
    else if (priority != NULL)
        (void)json_object_set(settings, "priority", priority);
    return settings;
}

static bool is_order(const json_t *body)
{
    bool order = json_object_get(body, "end_time") != NULL;
    for (size_t index = 0; index < LOOK_COUNT; index++)
        order = order || json_is_true(json_object_get(body, looks[index]));
    return order;
}

bool job_patch_empty(const json_t *body)
{
    return !is_order(body) && json_object_get(body, "priority") == NULL &&
           json_object_get(body, "labels") == NULL && json_object_get(body, "limits") == NULL;
}

static const struct json_field patch_fields[] = {
    {.key = "priority",
     .kind = FIELD_SAME,
     .optional = true,
     .nullable = true,
     .item = &submission_priority,
     .offset = FIELD_NOWHERE},
    {.key = "labels",
     .kind = FIELD_SAME,
     .optional = true,
     .nullable = true,
     .patch = true,
     .item = &submission_labels},
    {.key = "limits",
     .kind = FIELD_SAME,
     .optional = true,
     .nullable = true,
     .patch = true,
     .item = &submission_limits},
    {.key = "end_time",
     .kind = FIELD_NUMBER,
     .optional = true,
     .above_minimum = true,
     .offset = FIELD_NOWHERE,
     .meaning = "[s] at which the run is to end now; it must still be to come"},
    {.key = "checkpoint_now",
     .kind = FIELD_BOOLEAN,
     .optional = true,
     .offset = FIELD_NOWHERE,
     .meaning = "write a checkpoint"},
    {.key = "frame_now",
     .kind = FIELD_BOOLEAN,
     .optional = true,
     .offset = FIELD_NOWHERE,
     .meaning = "write a frame"},
    {.key = NULL},
};
const struct json_field schema_job_patch = {
    .kind = FIELD_OBJECT, .schema = "JobPatch", .fields = patch_fields};

void job_patch_check(const json_t *body, const struct job *job, double time, json_t *errors)
{
    struct job patched = {0};
    if (!json_is_object(body)) {
        issue_add(errors, "", "type", NULL, NULL, "the body must be an object");
        return;
    }
    json_fields_read(patch_fields, body, "", &patched, errors);
    const json_t *end_time = json_object_get(body, "end_time");
    if (json_is_number(end_time) && json_number_value(end_time) > 0 &&
        !(json_number_value(end_time) > time))
        issue_add(errors, "/end_time", "past", end_time, NULL,
                  "the run has reached %.6g s and cannot end before that", time);
    if (json_array_size(errors) > 0)
        return;
    json_t *settings = settings_merge(job, body); /* the whole may have too many labels */
    submission_settings_read(settings, &patched, errors);
    json_decref(settings);
    job_release(&patched);
}

/* Notes the orders in the job: another end replaces the one before, looks are counted. */
static enum talus_status orders_note(struct job *job, const json_t *body, struct talus_error *error)
{
    json_t *steering = json_loads(job->steering == NULL ? "{}" : job->steering, 0, NULL);
    json_t *end_time = json_object_get(body, "end_time");
    bool good = steering != NULL;
    if (good && end_time != NULL)
        good = json_object_set(steering, "end_time", end_time) == 0;
    for (size_t index = 0; index < LOOK_COUNT && good; index++) {
        json_int_t count = json_integer_value(json_object_get(steering, looks[index]));
        if (json_is_true(json_object_get(body, looks[index])))
            good = json_object_set_new(steering, looks[index], json_integer(count + 1)) == 0;
    }
    enum talus_status status =
        good ? job_json_set(&job->steering, steering, error) : talus_error_memory(error);
    json_decref(steering);
    job->steered = 1;
    return status;
}

enum talus_status job_patch_apply(struct job *job, const json_t *body, struct talus_error *error)
{
    const char *state = job_state_name((enum job_state)job->state);
    bool order = is_order(body);
    if (job_state_final((enum job_state)job->state))
        return talus_error_set(error, TALUS_LIMIT, "state", "",
                               "the job is %s and cannot be changed any more", state);
    if (order && job->state != JOB_RUNNING)
        return talus_error_set(error, TALUS_LIMIT, "state", "",
                               "the job is %s; only a running one can be steered", state);
    json_t *errors = json_array(), *settings = settings_merge(job, body);
    submission_settings_read(settings, job, errors);
    /* Checked before, so this is a patch that came in between. */
    size_t mistakes = json_array_size(errors);
    json_decref(errors);
    json_decref(settings);
    if (mistakes > 0)
        return talus_error_set(error, TALUS_LIMIT, "labels", "", "the job has too many labels");
    return order ? orders_note(job, body, error) : TALUS_OK;
}

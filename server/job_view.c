/* SPDX-License-Identifier: Apache-2.0 */
/* A job as clients see it. */
#include "jobs.h"
#include "json_text.h"
#include "supervisor.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

static json_t *text_json(const char *text)
{
    return text == NULL ? json_null() : json_string(text);
}

static json_t *document_json(const char *text, const char *missing)
{
    json_t *value = json_loads(text == NULL ? missing : text, JSON_DECODE_ANY, NULL);
    return value == NULL ? json_null() : value;
}

static json_t *links_json(const struct job *job)
{
    static const char *const names[] = {"events", "series", "frames", "files",
                                        "log",    "cancel", "resume"};
    char path[128];
    json_t *links = json_object();
    (void)snprintf(path, sizeof path, "/v1/jobs/%s", job->id);
    (void)json_object_set_new(links, "self", json_string(path));
    for (size_t index = 0; index < sizeof names / sizeof names[0]; index++) {
        (void)snprintf(path, sizeof path, "/v1/jobs/%s/%s", job->id, names[index]);
        (void)json_object_set_new(links, names[index], json_string(path));
    }
    return links;
}

/* Of a job whose worker has told nothing yet: all of its own time is left, as forecast. */
static json_t *progress_first(const struct job *job)
{
    json_t *progress = json_pack("{s:i, s:i, s:i}", "fraction", 0, "time", 0, "step", 0);
    json_t *forecast = job_state_final((enum job_state)job->state)
                           ? NULL
                           : json_loads(job->forecast == NULL ? "" : job->forecast, 0, NULL);
    json_t *expected = json_object_get(json_object_get(forecast, "wall_seconds"), "expected");
    if (expected != NULL)
        (void)json_object_set(progress, "eta_seconds", expected);
    json_decref(forecast);
    return progress;
}

static json_t *progress_json(struct service *service, const struct job *job)
{
    json_t *progress =
        job->state == JOB_RUNNING ? supervisor_progress(service->supervisor, job->id) : NULL;
    if (progress != NULL)
        return progress;
    return job->progress != NULL ? document_json(job->progress, "null") : progress_first(job);
}

/* Columns whose text is a member of the view: reading and writing them again would be most of the
 * work that a job costs a reader. */
static const struct {
    const char *key;
    size_t offset; /* in struct job */
    const char *missing;
} documents[] = {
    {"steering", offsetof(struct job, steering), "null"},
    {"labels", offsetof(struct job, labels), "{}"},
    {"attempts", offsetof(struct job, attempts), "[]"},
    {"forecast", offsetof(struct job, forecast), "null"},
    {"advice", offsetof(struct job, advice), "[]"},
    {"warnings", offsetof(struct job, warnings), "[]"},
    {"metrics", offsetof(struct job, metrics), "null"},
    {"receipt", offsetof(struct job, receipt), "null"},
};
enum { DOCUMENT_COUNT = sizeof documents / sizeof documents[0] };

/* Everything but the documents that the store holds as they are told. */
static json_t *plain_members(struct service *service, const struct job *job)
{
    json_t *view = json_object();
    const char *state = job_state_name((enum job_state)job->state);
    (void)json_object_set_new(view, "id", json_string(job->id));
    (void)json_object_set_new(view, "name", text_json(job->name));
    (void)json_object_set_new(view, "state", json_string(state));
    (void)json_object_set_new(view, "reason", text_json(job->reason));
    (void)json_object_set_new(view, "detail", text_json(job->detail));
    (void)json_object_set_new(view, "study", text_json(job->study));
    (void)json_object_set_new(view, "study_row",
                              job->study == NULL ? json_null() : json_integer(job->study_row));
    (void)json_object_set_new(view, "owner", text_json(job->owner));
    (void)json_object_set_new(view, "reused_from", text_json(job->reused_from));
    (void)json_object_set_new(view, "steered", json_boolean(job->steered));
    (void)json_object_set_new(view, "cancel_requested",
                              json_boolean(job->cancel_requested && job->state == JOB_RUNNING));
    (void)json_object_set_new(view, "revision", json_integer(job->revision));
    (void)json_object_set_new(view, "priority", json_integer(job->priority));
    (void)json_object_set_new(view, "threads", json_integer(job->threads));
    (void)json_object_set_new(view, "limits", job_limits_json(job));
    (void)json_object_set_new(view, "retries", json_integer(job->retries));
    (void)json_object_set_new(view, "created_at", text_json(job->created_at));
    (void)json_object_set_new(view, "started_at", text_json(job->started_at));
    (void)json_object_set_new(view, "finished_at", text_json(job->finished_at));
    (void)json_object_set_new(view, "progress", progress_json(service, job));
    (void)json_object_set_new(view, "scene_hash", text_json(job->scene_hash));
    (void)json_object_set_new(view, "links", links_json(job));
    return view;
}

/* Whether a comma-separated list (NULL: of all) has a name. */
static bool field_wanted(const char *fields, const char *key)
{
    size_t length = strlen(key);
    bool wanted = fields == NULL;
    for (const char *field = fields; field != NULL && !wanted; field = strchr(field, ',')) {
        field += *field == ',';
        wanted =
            strncmp(field, key, length) == 0 && (field[length] == ',' || field[length] == '\0');
    }
    return wanted;
}

static json_t *members_thin(json_t *view, const char *fields)
{
    const char *key;
    json_t *value;
    void *next;
    json_object_foreach_safe(view, next, key, value)
    {
        if (!field_wanted(fields, key))
            (void)json_object_del(view, key);
    }
    return view;
}

void jobs_text_add(struct text *text, struct service *service, const struct job *job,
                   const char *fields)
{
    json_t *plain = members_thin(plain_members(service, job), fields);
    const char *separator = json_object_size(plain) == 0 ? "" : ",";
    json_text_add(text, plain, 0);
    if (!text->failed)
        text_cut(text, text->length - 1); /* the brace that closes it */
    for (size_t index = 0; index < DOCUMENT_COUNT; index++) {
        const char *const *member =
            (const char *const *)(const void *)((const char *)job + documents[index].offset);
        if (!field_wanted(fields, documents[index].key))
            continue;
        text_print(text, "%s\"%s\":", separator, documents[index].key);
        text_add_string(text, *member == NULL ? documents[index].missing : *member);
        separator = ",";
    }
    text_add_string(text, "}");
    json_decref(plain);
}

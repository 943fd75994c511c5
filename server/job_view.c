/* SPDX-License-Identifier: Apache-2.0 */
/* A job as clients see it. */
#include "jobs.h"
#include "json_text.h"
#include "supervisor.h"

#include <stddef.h>
#include <string.h>

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

/* A view as it grows. A tree of JSON values would be most of what a list costs. */
struct view {
    struct text *text;
    const char *fields, *separator;
};

/* Begins a member if it is wanted. */
static bool member_begin(struct view *view, const char *key)
{
    if (!field_wanted(view->fields, key))
        return false;
    text_add_string(view->text, view->separator);
    text_add_string(view->text, key);
    text_add_string(view->text, "\":");
    view->separator = ",\"";
    return true;
}

static void member_text(struct view *view, const char *key, const char *value)
{
    if (!member_begin(view, key))
        return;
    if (value == NULL)
        text_add_string(view->text, "null");
    else
        json_text_add_string(view->text, value);
}

static void member_integer(struct view *view, const char *key, int64_t value)
{
    if (member_begin(view, key))
        text_add_integer(view->text, value);
}

static void member_boolean(struct view *view, const char *key, bool value)
{
    if (member_begin(view, key))
        text_add_string(view->text, value ? "true" : "false");
}

/* Takes the value over. */
static void member_json(struct view *view, const char *key, json_t *value)
{
    if (member_begin(view, key))
        json_text_add(view->text, value, 0);
    json_decref(value);
}

static void member_progress(struct view *view, struct service *service, const struct job *job)
{
    if (!field_wanted(view->fields, "progress"))
        return;
    json_t *live =
        job->state == JOB_RUNNING ? supervisor_progress(service->supervisor, job->id) : NULL;
    if (live != NULL || job->progress == NULL)
        member_json(view, "progress", live != NULL ? live : progress_first(job));
    else if (member_begin(view, "progress"))
        text_add_string(view->text, job->progress);
}

static void member_links(struct view *view, const struct job *job)
{
    static const char *const names[] = {"events", "series", "frames", "files",
                                        "log",    "cancel", "resume"};
    const char *const begin = "\":\"/v1/jobs/";
    if (!member_begin(view, "links"))
        return;
    text_add_string(view->text, "{\"self");
    text_add_string(view->text, begin);
    text_add_string(view->text, job->id);
    for (size_t index = 0; index < sizeof names / sizeof names[0]; index++) {
        text_add_string(view->text, "\",\"");
        text_add_string(view->text, names[index]);
        text_add_string(view->text, begin);
        text_add_string(view->text, job->id);
        text_add_string(view->text, "/");
        text_add_string(view->text, names[index]);
    }
    text_add_string(view->text, "\"}");
}

/* Everything but the documents that the store holds as they are told. */
static void plain_members(struct view *view, struct service *service, const struct job *job)
{
    member_text(view, "id", job->id);
    member_text(view, "name", job->name);
    member_text(view, "state", job_state_name((enum job_state)job->state));
    member_text(view, "reason", job->reason);
    member_text(view, "detail", job->detail);
    member_text(view, "study", job->study);
    if (job->study == NULL)
        member_text(view, "study_row", NULL);
    else
        member_integer(view, "study_row", job->study_row);
    member_text(view, "owner", job->owner);
    member_text(view, "reused_from", job->reused_from);
    member_boolean(view, "steered", job->steered != 0);
    member_boolean(view, "cancel_requested", job->cancel_requested && job->state == JOB_RUNNING);
    member_integer(view, "revision", job->revision);
    member_integer(view, "priority", job->priority);
    member_integer(view, "threads", job->threads);
    member_json(view, "limits", job_limits_json(job));
    member_integer(view, "retries", job->retries);
    member_text(view, "created_at", job->created_at);
    member_text(view, "started_at", job->started_at);
    member_text(view, "finished_at", job->finished_at);
    member_progress(view, service, job);
    member_text(view, "scene_hash", job->scene_hash);
    member_links(view, job);
}

void jobs_text_add(struct text *text, struct service *service, const struct job *job,
                   const char *fields)
{
    struct view view = {.text = text, .fields = fields, .separator = "\""};
    text_add_string(text, "{");
    plain_members(&view, service, job);
    for (size_t index = 0; index < DOCUMENT_COUNT; index++) {
        const char *const *member =
            (const char *const *)(const void *)((const char *)job + documents[index].offset);
        if (member_begin(&view, documents[index].key))
            text_add_string(text, *member == NULL ? documents[index].missing : *member);
    }
    text_add_string(text, "}");
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "submission.h"

#include "json_pointer.h"
#include "reply.h"
#include "suggest.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAME_BYTES = 256, LABELS_MAX = 64, DEFAULT_RETRIES = 2 };

static void range_issue(json_t *errors, const char *pointer, const json_t *given, double low,
                        double high)
{
    json_t *allowed = json_pack("{s:f, s:f}", "minimum", low, "maximum", high);
    issue_add(errors, pointer, json_is_number(given) ? "range" : "type", given, allowed,
              "a number from %.15g to %.15g is wanted", low, high);
    json_decref(allowed);
}

static int64_t integer_read(const json_t *object, const char *key, const char *pointer, int64_t low,
                            int64_t high, int64_t missing, json_t *errors)
{
    const json_t *value = json_object_get(object, key);
    double number = json_number_value(value);
    if (value == NULL)
        return missing;
    if (!json_is_number(value) || number < (double)low || number > (double)high) {
        range_issue(errors, pointer, value, (double)low, (double)high);
        return missing;
    }
    if (floor(number) < number) {
        issue_add(errors, pointer, "type", value, NULL, "a whole number is wanted");
        return missing;
    }
    return (int64_t)number;
}

void submission_keys_check(const json_t *object, const char *parent, const char *const *known,
                           json_t *errors)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    {
        char pointer[JSON_POINTER_SIZE];
        bool found = false;
        for (size_t index = 0; known[index] != NULL; index++)
            found = found || strcmp(known[index], key) == 0;
        if (found)
            continue;
        const char *near = suggest(key, known);
        json_pointer_join(pointer, parent, key);
        issue_add(errors, pointer, "unknown_key", NULL, NULL, "unknown key%s%s%s",
                  near == NULL ? "" : "; did you mean \"", near == NULL ? "" : near,
                  near == NULL ? "" : "\"?");
    }
}

static void name_read(const json_t *body, struct job *job, json_t *errors)
{
    const json_t *name = json_object_get(body, "name");
    struct talus_error error = {0};
    if (name == NULL)
        return;
    if (!json_is_string(name) || json_string_length(name) > NAME_BYTES)
        issue_add(errors, "/name", "type", name, NULL, "a string of at most %d bytes is wanted",
                  NAME_BYTES);
    else if (job_text_set(&job->name, json_string_value(name), &error) != TALUS_OK)
        issue_add(errors, "/name", "memory", NULL, NULL, "out of memory");
}

static void labels_read(const json_t *body, struct job *job, json_t *errors)
{
    json_t *labels = json_object_get(body, "labels");
    struct talus_error error = {0};
    const char *key;
    json_t *value;
    if (labels == NULL)
        return;
    if (!json_is_object(labels) || json_object_size(labels) > LABELS_MAX) {
        issue_add(errors, "/labels", "type", labels, NULL,
                  "an object of at most %d strings is wanted", LABELS_MAX);
        return;
    }
    json_object_foreach(labels, key, value)
    {
        if (json_is_string(value) && strlen(key) <= NAME_BYTES &&
            json_string_length(value) <= NAME_BYTES && strchr(key, ':') == NULL)
            continue;
        char pointer[NAME_BYTES + 16];
        (void)snprintf(pointer, sizeof pointer, "/labels/%s", key);
        issue_add(errors, pointer, "type", value, NULL,
                  "a label is a string of at most %d bytes under a key without a colon",
                  NAME_BYTES);
    }
    if (job_json_set(&job->labels, labels, &error) != TALUS_OK)
        issue_add(errors, "/labels", "memory", NULL, NULL, "out of memory");
}

static void limits_read(const json_t *body, struct job *job, json_t *errors)
{
    static const char *const known[] = {"wall_seconds", "memory_bytes", "disk_bytes", NULL};
    const json_t *limits = json_object_get(body, "limits");
    if (limits == NULL)
        return;
    if (!json_is_object(limits)) {
        issue_add(errors, "/limits", "type", limits, NULL, "an object is wanted");
        return;
    }
    submission_keys_check(limits, "/limits", known, errors);
    const json_t *wall = json_object_get(limits, "wall_seconds");
    job->wall_limit = json_number_value(wall);
    if (wall != NULL && (!json_is_number(wall) || job->wall_limit < 1e-3 || job->wall_limit > 1e9))
        range_issue(errors, "/limits/wall_seconds", wall, 1e-3, 1e9);
    job->memory_limit = integer_read(limits, "memory_bytes", "/limits/memory_bytes", 1 << 20,
                                     INT64_C(1) << 50, 0, errors);
    job->disk_limit = integer_read(limits, "disk_bytes", "/limits/disk_bytes", 1 << 16,
                                   INT64_C(1) << 50, 0, errors);
}

void submission_settings_read(const json_t *body, struct job *job, json_t *errors)
{
    labels_read(body, job, errors);
    limits_read(body, job, errors);
    job->priority = integer_read(body, "priority", "/priority", -100, 100, 0, errors);
}

void submission_read(const json_t *body, int64_t workers, struct job *job, const json_t **scene,
                     json_t *errors)
{
    static const char *const known[] = {"scene",  "name",    "labels", "priority", "threads",
                                        "limits", "retries", "reuse",  NULL};
    *scene = json_object_get(body, "scene");
    if (!json_is_object(body)) {
        issue_add(errors, "", "type", NULL, NULL, "the body must be an object");
        return;
    }
    submission_keys_check(body, "", known, errors);
    if (*scene == NULL)
        issue_add(errors, "/scene", "required", NULL, NULL, "the scene is missing");
    name_read(body, job, errors);
    submission_settings_read(body, job, errors);
    job->threads = integer_read(body, "threads", "/threads", 0, workers, 1, errors);
    job->retries = integer_read(body, "retries", "/retries", 0, 100, DEFAULT_RETRIES, errors);
    const json_t *reuse = json_object_get(body, "reuse");
    if (reuse != NULL && !json_is_boolean(reuse))
        issue_add(errors, "/reuse", "type", reuse, NULL, "true or false is wanted");
}

bool submission_reuse(const json_t *body)
{
    return json_is_true(json_object_get(body, "reuse"));
}

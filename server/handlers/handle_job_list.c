/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/jobs */
#include "identifier.h"
#include "jobs.h"
#include "request.h"
#include "schemas.h"

#include <stdlib.h>
#include <string.h>

enum { LIMIT_DEFAULT = 100, LIMIT_MAX = 500 };

struct list {
    struct service *service;
    json_t *jobs;
    const char *fields; /* comma-separated, NULL: all */
    size_t limit;
    char last[IDENTIFIER_LENGTH + 1];
    bool more;
};

static bool field_wanted(const char *fields, const char *key)
{
    size_t length = strlen(key);
    for (const char *field = fields; field != NULL; field = strchr(field, ',')) {
        field += *field == ',';
        if (strncmp(field, key, length) == 0 && (field[length] == ',' || field[length] == '\0'))
            return true;
    }
    return false;
}

static json_t *view_thin(json_t *view, const char *fields)
{
    const char *key;
    json_t *value;
    void *next;
    if (fields == NULL)
        return view;
    json_object_foreach_safe(view, next, key, value)
    {
        if (!field_wanted(fields, key))
            (void)json_object_del(view, key);
    }
    return view;
}

static bool list_add(const struct job *job, void *context)
{
    struct list *list = context;
    if (json_array_size(list->jobs) == list->limit) {
        list->more = true;
        return false;
    }
    json_t *view = view_thin(jobs_json(list->service, job), list->fields);
    (void)json_array_append_new(list->jobs, view);
    (void)strncpy(list->last, job->id, IDENTIFIER_LENGTH);
    return true;
}

static void query_refused(struct request *request, const char *parameter, const char *detail)
{
    json_t *errors = json_pack("[{s:s, s:s, s:s, s:s}]", "pointer", "", "parameter", parameter,
                               "code", "unknown_value", "detail", detail);
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "query", request->raw, errors,
                  "query parameter %s: %s", parameter, detail);
}

/* Reads the filter; `label` is storage for its key. False: the reply is made. */
static bool filter_read(struct request *request, struct store_filter *filter, char **label)
{
    const char *state = target_query(&request->target, "state");
    const char *pair = target_query(&request->target, "label");
    const char *cursor = target_query(&request->target, "cursor");
    filter->state = state == NULL ? JOB_STATE_COUNT : job_state_find(state);
    if (pair != NULL) {
        *label = strdup(pair);
        char *colon = *label == NULL ? NULL : strchr(*label, ':');
        if (colon == NULL) {
            query_refused(request, "label", "a label is asked for as key:value");
            return false;
        }
        *colon = '\0';
        filter->label_key = *label;
        filter->label_value = colon + 1;
    }
    if (cursor != NULL && !identifier_valid(cursor)) {
        query_refused(request, "cursor", "this is no cursor of this list");
        return false;
    }
    filter->before = cursor;
    return true;
}

/* Whether every field asked for is one of a job. False: the reply is made. */
static bool fields_check(struct request *request, const char *fields)
{
    const struct job empty = {.id = (char[]){""}};
    if (fields == NULL)
        return true;
    json_t *view = jobs_json(request->service, &empty);
    size_t found = 0, wanted = 1;
    const char *key;
    json_t *value;
    json_object_foreach(view, key, value)
    {
        found += field_wanted(fields, key);
    }
    for (const char *comma = strchr(fields, ','); comma != NULL; comma = strchr(comma + 1, ','))
        wanted++;
    json_decref(view);
    if (found != wanted)
        query_refused(request, "fields", "a list of different members of a job is wanted");
    return found == wanted;
}

const struct operation operation_job_list = {
    .summary = "Jobs, newest first",
    .query =
        (const struct json_field[]){
            {.key = "state",
             .kind = FIELD_TEXT,
             .optional = true,
             .words = job_state_words,
             .meaning = "only those in this state"},
            {.key = "label",
             .kind = FIELD_TEXT,
             .optional = true,
             .meaning = "KEY:VALUE: only those with this label"},
            {.key = "fields",
             .kind = FIELD_TEXT,
             .optional = true,
             .meaning = "only these members of every job, separated by commas"},
            {.key = "limit",
             .kind = FIELD_INTEGER,
             .optional = true,
             .minimum = 1,
             .maximum = LIMIT_MAX,
             .preset = LIMIT_DEFAULT,
             .meaning = "so many at most"},
            {.key = "cursor",
             .kind = FIELD_TEXT,
             .optional = true,
             .meaning = "of the page before"},
            OPERATION_END},
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_job_list,
                                            .meaning = "a page of jobs"},
                                           RESPONSE_END},
};

enum handled handle_job_list(struct request *request)
{
    struct talus_error error = {0};
    struct store_filter filter = {.state = JOB_STATE_COUNT};
    char *label = NULL;
    const double limit = request_query_number(request, "limit");
    const char *fields = target_query(&request->target, "fields");
    if (!fields_check(request, fields) || !filter_read(request, &filter, &label)) {
        free(label);
        return HANDLED;
    }
    struct list list = {.service = request->service,
                        .jobs = json_array(),
                        .fields = fields,
                        .limit = (size_t)limit};
    filter.limit = (int64_t)limit + 1;
    if (store_job_list(request->service->store, &filter, list_add, &list, &error) == TALUS_OK) {
        json_t *cursor = list.more ? json_string(list.last) : json_null();
        reply_json(&request->reply, MHD_HTTP_OK,
                   json_pack("{s:O, s:o}", "jobs", list.jobs, "cursor", cursor));
    } else {
        reply_error(&request->reply, request->raw, &error);
    }
    json_decref(list.jobs);
    free(label);
    return HANDLED;
}

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
    struct text text;   /* the answer so far */
    const char *fields; /* comma-separated, NULL: all */
    size_t limit, count;
    char last[IDENTIFIER_LENGTH + 1];
    bool more;
};

static bool list_add(const struct job *job, void *context)
{
    struct list *list = context;
    if (list->count == list->limit) {
        list->more = true;
        return false;
    }
    if (list->count++ > 0)
        text_add_string(&list->text, ",");
    jobs_text_add(&list->text, list->service, job, list->fields);
    (void)strncpy(list->last, job->id, IDENTIFIER_LENGTH);
    return true;
}

/* Reads the filter; `label` is storage for its key. False: the reply is made. */
static bool filter_read(struct request *request, struct store_filter *filter, char **label)
{
    const char *state = target_query(&request->target, "state");
    const char *pair = target_query(&request->target, "label");
    const char *cursor = target_query(&request->target, "cursor");
    filter->study = target_query(&request->target, "study");
    filter->state = state == NULL ? JOB_STATE_COUNT : job_state_find(state);
    if (pair != NULL) {
        *label = strdup(pair);
        char *colon = *label == NULL ? NULL : strchr(*label, ':');
        if (colon == NULL) {
            request_query_refuse(request, "label", "a label is asked for as key:value");
            return false;
        }
        *colon = '\0';
        filter->label_key = *label;
        filter->label_value = colon + 1;
    }
    if (cursor != NULL && !identifier_valid(cursor)) {
        request_query_refuse(request, "cursor", "this is no cursor of this list");
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
    struct text text = {0};
    size_t wanted = 1;
    jobs_text_add(&text, request->service, &empty, fields);
    json_t *view = text.failed ? NULL : json_loadb(text.data, text.length, 0, NULL);
    size_t found = json_object_size(view);
    for (const char *comma = strchr(fields, ','); comma != NULL; comma = strchr(comma + 1, ','))
        wanted++;
    json_decref(view);
    text_release(&text);
    if (found != wanted)
        request_query_refuse(request, "fields", "a list of different members of a job is wanted");
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
            {.key = "study",
             .kind = FIELD_TEXT,
             .optional = true,
             .meaning = "only the jobs of this study"},
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
    struct list list = {.service = request->service, .fields = fields, .limit = (size_t)limit};
    filter.limit = (int64_t)limit + 1;
    text_add_string(&list.text, "{\"jobs\":[");
    if (store_job_list(request->service->store, &filter, list_add, &list, &error) == TALUS_OK) {
        const char *quote = list.more ? "\"" : "";
        text_print(&list.text, "],\"cursor\":%s%s%s}", quote, list.more ? list.last : "null",
                   quote);
        reply_json_text(&request->reply, MHD_HTTP_OK, &list.text);
    } else {
        reply_error(&request->reply, request->raw, &error);
    }
    text_release(&list.text);
    free(label);
    return HANDLED;
}

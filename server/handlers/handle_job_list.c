/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/jobs */
#include "identifier.h"
#include "jobs.h"
#include "list_page.h"
#include "request.h"
#include "schemas.h"

#include <string.h>

enum { LABEL_KEY_BYTES = 300 };

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

/* Reads the labels that are asked for; `keys` is storage. False: the reply is made. */
static bool labels_read(struct request *request, struct store_filter *filter,
                        char keys[STORE_LABEL_MAX][LABEL_KEY_BYTES])
{
    for (size_t index = 0; index < request->target.query_count; index++) {
        const struct target_parameter *parameter = &request->target.query[index];
        if (strcmp(parameter->name, "label") != 0)
            continue;
        const char *colon = strchr(parameter->value, ':');
        size_t length = colon == NULL ? LABEL_KEY_BYTES : (size_t)(colon - parameter->value);
        if (length >= LABEL_KEY_BYTES || filter->label_count == STORE_LABEL_MAX) {
            request_query_refuse(request, "label", "a label is asked for as key:value");
            return false;
        }
        char *key = keys[filter->label_count];
        memcpy(key, parameter->value, length);
        key[length] = '\0';
        filter->labels[filter->label_count++] = (struct store_label){key, colon + 1};
    }
    return true;
}

/* Reads the filter; `keys` is storage of its labels. False: the reply is made. */
static bool filter_read(struct request *request, struct store_filter *filter,
                        char keys[STORE_LABEL_MAX][LABEL_KEY_BYTES])
{
    const char *state = target_query(&request->target, "state");
    filter->study = target_query(&request->target, "study");
    filter->state = state == NULL ? JOB_STATE_COUNT : job_state_find(state);
    filter->text = target_query(&request->target, "text");
    return labels_read(request, filter, keys);
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
             .kind = FIELD_LIST,
             .item = &(const struct json_field){.kind = FIELD_TEXT},
             .optional = true,
             .meaning = "KEY:VALUE: only those with this label; may be repeated, for several"},
            {.key = "text",
             .kind = FIELD_TEXT,
             .optional = true,
             .meaning = "only those whose name contains this; the case of ASCII letters does not "
                        "count"},
            {.key = "study",
             .kind = FIELD_TEXT,
             .optional = true,
             .meaning = "only the jobs of this study"},
            {.key = "fields",
             .kind = FIELD_TEXT,
             .optional = true,
             .meaning = "only these members of every job, separated by commas"},
            LIST_PAGE_QUERY,
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
    char keys[STORE_LABEL_MAX][LABEL_KEY_BYTES];
    struct list_page page;
    const char *fields = target_query(&request->target, "fields");
    if (!fields_check(request, fields) || !filter_read(request, &filter, keys) ||
        !list_page_read(request, &page))
        return HANDLED;
    struct list list = {.service = request->service, .fields = fields, .limit = page.limit};
    filter.before = page.before;
    filter.limit = (int64_t)page.limit + 1;
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
    return HANDLED;
}

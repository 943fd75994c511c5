/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/studies */
#include "list_page.h"
#include "request.h"
#include "schemas.h"
#include "service.h"
#include "studies/study_store.h"
#include "studies/study_view.h"

static bool list_add(const struct study *study, void *context)
{
    return json_array_append_new(context, json_string(study->id)) == 0;
}

/* The studies of a page; the store is not held while they are looked at. */
static json_t *page_json(struct service *service, const json_t *ids, size_t limit)
{
    json_t *studies = json_array();
    size_t index;
    const json_t *id;
    json_array_foreach(ids, index, id)
    {
        struct study study = {0};
        struct talus_error error = {0};
        if (index < limit && study_store_read(service->store, json_string_value(id), false, &study,
                                              &error) == TALUS_OK)
            (void)json_array_append_new(studies, study_view(service, &study));
        study_release(&study);
    }
    json_t *last = json_array_size(ids) > limit ? json_array_get(ids, limit - 1) : NULL;
    return json_pack("{s:o, s:o}", "studies", studies, "cursor",
                     last == NULL ? json_null() : json_incref(last));
}

const struct operation operation_study_list = {
    .summary = "Studies, newest first",
    .query = (const struct json_field[]){{.key = "state",
                                          .kind = FIELD_TEXT,
                                          .optional = true,
                                          .words = study_state_words,
                                          .meaning = "only those in this state"},
                                         LIST_PAGE_QUERY,
                                         OPERATION_END},
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_study_list,
                                            .meaning = "a page of studies"},
                                           RESPONSE_END},
};

enum handled handle_study_list(struct request *request)
{
    struct talus_error error = {0};
    const char *state = target_query(&request->target, "state");
    struct list_page page;
    if (!list_page_read(request, &page))
        return HANDLED;
    const struct study_filter filter = {.state = state == NULL ? STUDY_STATE_COUNT
                                                               : study_state_find(state),
                                        .before = page.before,
                                        .limit = (int64_t)page.limit + 1};
    json_t *ids = json_array();
    if (study_store_list(request->service->store, &filter, list_add, ids, &error) == TALUS_OK)
        reply_json(&request->reply, MHD_HTTP_OK, page_json(request->service, ids, page.limit));
    else
        reply_error(&request->reply, request->raw, &error);
    json_decref(ids);
    return HANDLED;
}

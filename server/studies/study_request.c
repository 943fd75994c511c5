/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_request.h"

#include "admission.h"
#include "identifier.h"
#include "revision.h"
#include "service.h"
#include "studies/study_store.h"
#include "studies/study_view.h"

#include <string.h>

const struct json_field operation_study_path[] = {
    {.key = "study", .kind = FIELD_TEXT, .meaning = "id of a study"}, OPERATION_END};

bool study_request_read(struct request *request, bool whole, struct study *study)
{
    struct talus_error error = {0};
    memset(study, 0, sizeof *study);
    if (!identifier_valid(request->segment)) {
        reply_problem(&request->reply, MHD_HTTP_NOT_FOUND, "not_found", request->raw, NULL,
                      "there is no such study");
        return false;
    }
    if (study_store_read(request->service->store, request->segment, whole, study, &error) ==
        TALUS_OK)
        return true;
    reply_error(&request->reply, request->raw, &error);
    return false;
}

bool study_request_check(struct request *request, const json_t *body, struct study_draft *draft)
{
    struct talus_error error = {0};
    enum talus_status status = TALUS_OK;
    json_t *errors = json_array();
    study_draft_read(body, request->service->config, draft, errors);
    if (json_array_size(errors) == 0)
        status = study_draft_check(draft, request->service, request->helper, errors, &error);
    bool good = status == TALUS_OK && json_array_size(errors) == 0;
    if (status != TALUS_OK)
        reply_error(&request->reply, request->raw, &error);
    else if (!good)
        admission_refused(request, errors);
    json_decref(errors);
    return good;
}

void study_reply(struct request *request, unsigned int status, const struct study *study)
{
    char etag[REVISION_ETAG_SIZE];
    revision_etag(study->revision, etag);
    reply_json(&request->reply, status, study_view(request->service, study));
    reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
}

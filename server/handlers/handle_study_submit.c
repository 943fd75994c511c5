/* SPDX-License-Identifier: Apache-2.0 */
/* POST /v1/studies: every scene of a study is checked by a helper before the study is stored. */
#include "admission.h"
#include "body.h"
#include "request.h"
#include "schemas.h"
#include "service.h"
#include "studies/study_draft.h"
#include "studies/study_life.h"
#include "studies/study_request.h"

static void reply_stored(struct request *request, const char *id, bool replayed)
{
    struct talus_error error = {0};
    struct study study = {0};
    if (study_store_read(request->service->store, id, true, &study, &error) == TALUS_OK) {
        study_reply(request, MHD_HTTP_CREATED, &study);
        admission_made(request, "/v1/studies/", id, replayed);
    } else {
        reply_error(&request->reply, request->raw, &error);
    }
    study_release(&study);
}

/* Answers for a key that is known. */
static void reply_known(struct request *request, const struct admission *admission)
{
    if (admission->result == STORE_OTHER_BODY)
        admission_other_body(request);
    else
        reply_stored(request, admission->existing, true);
}

static void submit(struct request *request, const json_t *body, struct study_draft *draft)
{
    struct service *service = request->service;
    struct talus_error error = {0};
    struct admission admission;
    const struct store_key *key = &admission.key;
    if (!admission_key(request, body, &admission))
        return;
    if (admission.result != STORE_INSERTED) {
        reply_known(request, &admission);
        return;
    }
    if (!study_request_check(request, body, draft) || !admission_disk(request, draft->totals.disk))
        return;
    if (job_text_set(&draft->study.owner, request->principal.name, &error) != TALUS_OK ||
        study_create(service, &draft->study, draft->rows, key->key == NULL ? NULL : key,
                     &admission.result, admission.existing, &error) != TALUS_OK)
        reply_error(&request->reply, request->raw, &error);
    else if (admission.result != STORE_INSERTED)
        reply_known(request, &admission);
    else
        reply_stored(request, draft->study.id, false);
}

const struct operation operation_study_submit = {
    .summary = "Submits a study: a set of jobs from one scene",
    .headers = admission_key_headers,
    .body = &schema_study_submission,
    .responses =
        (const struct response[]){{.status = 201,
                                   .type = "application/json",
                                   .schema = &schema_study,
                                   .headers = admission_made_headers,
                                   .meaning = "the study is on disk; all its rows are checked"},
                                  RESPONSE_END},
    .problems = (const unsigned int[]){507, 0},
};

enum handled handle_study_submit(struct request *request)
{
    struct study_draft draft = {0};
    if (admission_draining(request))
        return HANDLED;
    json_t *body = body_json(request);
    if (body != NULL)
        submit(request, body, &draft);
    study_draft_release(&draft);
    json_decref(body);
    return HANDLED;
}

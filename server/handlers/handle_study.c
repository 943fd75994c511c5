/* SPDX-License-Identifier: Apache-2.0 */
/* GET, DELETE and cancel of one study. */
#include "body.h"
#include "request.h"
#include "revision.h"
#include "schemas.h"
#include "service.h"
#include "studies/study_life.h"
#include "studies/study_request.h"
#include "waits.h"

const struct operation operation_study = {
    .summary = "A study as it is",
    .path = operation_study_path,
    .query = revision_wait_query,
    .headers = revision_known_headers,
    .responses =
        (const struct response[]){
            {.status = 200,
             .type = "application/json",
             .schema = &schema_study,
             .headers = revision_headers,
             .meaning = "the study; its ETag changes with everything but progress"},
            REVISION_UNCHANGED,
            RESPONSE_END},
};

enum handled handle_study(struct request *request)
{
    struct service *service = request->service;
    revision_wait_begin(request);
    for (;;) {
        struct study study;
        uint64_t mark = waits_mark(service->waits);
        if (!study_request_read(request, true, &study))
            return HANDLED;
        bool due = revision_due(request, study.revision, study.state != STUDY_RUNNING);
        if (due && !revision_known(request, study.revision))
            study_reply(request, MHD_HTTP_OK, &study);
        study_release(&study);
        if (due)
            return HANDLED;
        if (waits_park(service->waits, request, mark))
            return HANDLED_PARKED;
    }
}

/* The revision that the call insists on. False: the reply is made. */
static bool control_begin(struct request *request, int64_t *revision)
{
    struct study study;
    if (!body_absent(request) || !study_request_read(request, false, &study))
        return false;
    bool matches = revision_wanted(request, "study", study.revision, revision);
    study_release(&study);
    return matches;
}

const struct operation operation_study_cancel = {
    .summary = "Cancels a study: rows that wait or are queued at once, those that run as soon as "
               "their processes end",
    .path = operation_study_path,
    .headers = revision_match_headers,
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_study,
                                            .headers = revision_headers,
                                            .meaning = "the study as it is now"},
                                           RESPONSE_END},
    .problems = revision_problems,
};

enum handled handle_study_cancel(struct request *request)
{
    int64_t revision;
    struct study study = {0};
    struct talus_error error = {0};
    if (!control_begin(request, &revision))
        return HANDLED;
    if (study_cancel(request->service, request->segment, revision, &study, &error) == TALUS_OK)
        study_reply(request, MHD_HTTP_OK, &study);
    else
        reply_error(&request->reply, request->raw, &error);
    study_release(&study);
    return HANDLED;
}

const struct operation operation_study_delete = {
    .summary = "Deletes a study that has ended, with its own jobs and all their files",
    .path = operation_study_path,
    .headers = revision_match_headers,
    .responses = (const struct response[]){{.status = 204, .meaning = "it is gone"}, RESPONSE_END},
    .problems = revision_problems,
};

enum handled handle_study_delete(struct request *request)
{
    int64_t revision;
    struct talus_error error = {0};
    if (!control_begin(request, &revision))
        return HANDLED;
    if (study_delete(request->service, request->segment, revision, &error) == TALUS_OK)
        reply_empty(&request->reply, MHD_HTTP_NO_CONTENT);
    else
        reply_error(&request->reply, request->raw, &error);
    return HANDLED;
}

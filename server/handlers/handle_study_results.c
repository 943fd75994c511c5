/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/studies/ID/results */
#include "request.h"
#include "schemas.h"
#include "studies/study_request.h"
#include "studies/study_view.h"

#include <string.h>

const struct operation operation_study_results = {
    .summary = "The table of a study: a row for each job, with parameters, state and metrics",
    .path = operation_study_path,
    .responses =
        (const struct response[]){
            {.status = 200,
             .type = "application/json",
             .schema = &schema_study_results,
             .meaning = "all rows so far"},
            {.status = 200, .type = "text/csv", .meaning = "the same with Accept: text/csv"},
            RESPONSE_END},
};

enum handled handle_study_results(struct request *request)
{
    struct study study;
    struct text text = {0};
    struct talus_error error = {0};
    const char *accept = request_header(request, MHD_HTTP_HEADER_ACCEPT);
    bool csv = accept != NULL && strstr(accept, "text/csv") != NULL;
    if (!study_request_read(request, false, &study))
        return HANDLED;
    enum talus_status status =
        csv ? study_results_csv(request->service, &study, &text, &error)
            : study_results_json(request->service, &study, STUDY_RESULTS_ASKED, &text, &error);
    if (status == TALUS_OK) {
        reply_text(&request->reply, MHD_HTTP_OK,
                   csv ? "text/csv; charset=utf-8; header=present" : "application/json", &text);
        reply_header(&request->reply, MHD_HTTP_HEADER_VARY, "Accept");
        reply_header(&request->reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
    } else {
        reply_error(&request->reply, request->raw, &error);
    }
    text_release(&text);
    study_release(&study);
    return HANDLED;
}

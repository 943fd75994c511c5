/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/studies/ID/chart.svg: a helper draws the table of the rows. */
#include "helper.h"
#include "request.h"
#include "service.h"
#include "studies/study_request.h"
#include "studies/study_units.h"
#include "studies/study_view.h"

#include <string.h>

/* What the study is to be drawn as: its own chart, or, for one of work and precision, the two that
 * its design names. NULL: nothing; new reference. */
static json_t *chart_of(const struct study *study)
{
    if (study->chart != NULL)
        return json_loads(study->chart, 0, NULL);
    if (study->kind != STUDY_WORK_PRECISION)
        return NULL;
    json_t *design = json_loads(study->design, 0, NULL);
    const json_t *own = json_object_get(design, "work_precision");
    json_t *names = json_loads(study->names, 0, NULL);
    const char *cost = json_string_value(json_object_get(own, "cost"));
    json_t *chart =
        json_pack("{s:s, s:O, s:O, s:b}", "x", cost == NULL ? "wall_seconds" : cost, "y",
                  json_object_get(own, "error"), "series", json_array_get(names, 0), "log", 1);
    json_decref(names);
    json_decref(design);
    return chart;
}

/* The question to the helper; NULL with *error set. */
static json_t *question_make(struct service *service, const struct study *study, json_t *chart,
                             struct talus_error *error)
{
    struct text text = {0};
    json_t *table = NULL, *question = NULL;
    if (study_results_json(service, study, STUDY_RESULTS_WANTED, &text, error) == TALUS_OK &&
        text.data != NULL && !text.failed)
        table = json_loadb(text.data, text.length, 0, NULL);
    if (table != NULL)
        question = json_pack("{s:s, s:O, s:O, s:s, s:s, s:o}", "op", "chart", "rows",
                             json_object_get(table, "rows"), "chart", chart, "kind",
                             study_kind_name((enum study_kind)study->kind), "title", study->name,
                             "units", study_units(service, json_object_get(table, "rows")));
    if (question == NULL && error->status == TALUS_OK)
        (void)talus_error_memory(error);
    json_decref(table);
    text_release(&text);
    return question;
}

/* Makes the reply out of what the helper says. */
static void reply_chart(struct request *request, const json_t *answer)
{
    const json_t *first = json_array_get(json_object_get(answer, "errors"), 0);
    const char *svg = json_string_value(json_object_get(answer, "svg"));
    const char *detail = json_string_value(json_object_get(first, "detail"));
    struct text text = {0};
    if (svg == NULL) {
        reply_problem(&request->reply, MHD_HTTP_CONFLICT, "chart", request->raw, NULL,
                      "the chart cannot be drawn: %s", detail == NULL ? "no answer" : detail);
        return;
    }
    text_add_string(&text, svg);
    reply_text(&request->reply, MHD_HTTP_OK, "image/svg+xml", &text);
    reply_header(&request->reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
    /* Shown by itself it must not run anything. */
    reply_header(&request->reply, "Content-Security-Policy",
                 "default-src 'none'; style-src 'unsafe-inline'");
}

static void chart_draw(struct request *request, const struct study *study, json_t *chart)
{
    struct talus_error error = {0};
    json_t *answer = NULL;
    json_t *question = question_make(request->service, study, chart, &error);
    if (question != NULL &&
        helper_ask(request->helper, question, request->service->config->render_seconds, &answer,
                   &error) == TALUS_OK)
        reply_chart(request, answer);
    else
        reply_error(&request->reply, request->raw, &error);
    json_decref(question);
    json_decref(answer);
}

const struct operation operation_study_chart = {
    .summary = "The chart of a study, drawn from the rows that have succeeded so far",
    .path = operation_study_path,
    .responses =
        (const struct response[]){{.status = 200, .type = "image/svg+xml", .meaning = "the chart"},
                                  RESPONSE_END},
    .problems = (const unsigned int[]){409, 0},
};

enum handled handle_study_chart(struct request *request)
{
    struct study study;
    if (!study_request_read(request, true, &study))
        return HANDLED;
    json_t *chart = chart_of(&study);
    if (chart == NULL)
        reply_problem(&request->reply, MHD_HTTP_NOT_FOUND, "no_chart", request->raw, NULL,
                      "the study was submitted without \"chart\"; its table is at "
                      "/v1/studies/%s/results",
                      study.id);
    else
        chart_draw(request, &study, chart);
    json_decref(chart);
    study_release(&study);
    return HANDLED;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_view.h"

#include "moment.h"
#include "studies/study_store.h"
#include "supervisor.h"

#include <stdio.h>

static json_t *text_json(const char *text)
{
    return text == NULL ? json_null() : json_string(text);
}

static json_t *document_json(const char *text, const char *missing)
{
    json_t *value = json_loads(text == NULL ? missing : text, JSON_DECODE_ANY, NULL);
    return value == NULL ? json_null() : value;
}

static json_t *counts_json(const struct study *study)
{
    json_t *counts = json_object();
    for (size_t state = 0; state < ROW_STATE_COUNT; state++)
        (void)json_object_set_new(counts, row_state_words[state],
                                  json_integer(study->counts[state]));
    (void)json_object_set_new(counts, "reused", json_integer(study->reused));
    (void)json_object_set_new(counts, "total", json_integer(study->row_count));
    return counts;
}

/* How far the rows that run are, together, in rows. */
static double running_fraction(struct service *service, const struct study *study)
{
    struct talus_error error = {0};
    double fraction = 0;
    size_t index;
    const json_t *id;
    json_t *jobs = json_array();
    if (study->counts[ROW_RUNNING] > 0 &&
        study_store_row_jobs(service->store, study->id, ROW_RUNNING, jobs, &error) != TALUS_OK)
        (void)fprintf(stderr, "talusd: study %s: %s\n", study->id, error.text);
    json_array_foreach(jobs, index, id)
    {
        json_t *progress = supervisor_progress(service->supervisor, json_string_value(id));
        fraction += json_number_value(json_object_get(progress, "fraction"));
        json_decref(progress);
    }
    json_decref(jobs);
    return fraction;
}

static json_t *progress_json(struct service *service, const struct study *study)
{
    bool runs = study->state == STUDY_RUNNING;
    double ended = (double)study_ended_count(study);
    double done = ended + (runs ? running_fraction(service, study) : 0);
    double all = (double)(study->rows_expected > 0 ? study->rows_expected : 1);
    double fraction = runs ? done / all : 1;
    /* By the pace since it began: rows differ, but there are many. */
    double elapsed = moment_now() - moment_parse(study->created_at);
    json_t *eta = runs && fraction > 0 && elapsed > 0
                      ? json_real(elapsed * (1 - fraction) / fraction)
                      : json_null();
    return json_pack("{s:f, s:I, s:I, s:o}", "fraction", fraction, "rows_ended", (json_int_t)ended,
                     "rows_expected", (json_int_t)study->rows_expected, "eta_seconds", eta);
}

static json_t *links_json(const struct study *study)
{
    static const struct {
        const char *name, *format;
    } links[] = {
        {"self", "/v1/studies/%s"},
        {"results", "/v1/studies/%s/results"},
        {"chart", "/v1/studies/%s/chart.svg"},
        {"events", "/v1/studies/%s/events"},
        {"cancel", "/v1/studies/%s/cancel"},
        {"jobs", "/v1/jobs?study=%s"},
    };
    json_t *view = json_object();
    for (size_t index = 0; index < sizeof links / sizeof links[0]; index++)
        (void)json_object_set_new(view, links[index].name,
                                  json_sprintf(links[index].format, study->id));
    return view;
}

json_t *study_view(struct service *service, const struct study *study)
{
    json_t *view = json_object();
    (void)json_object_set_new(view, "id", json_string(study->id));
    (void)json_object_set_new(view, "name", text_json(study->name));
    (void)json_object_set_new(view, "kind",
                              json_string(study_kind_name((enum study_kind)study->kind)));
    (void)json_object_set_new(view, "state",
                              json_string(study_state_name((enum study_state)study->state)));
    (void)json_object_set_new(view, "detail", text_json(study->detail));
    (void)json_object_set_new(view, "owner", text_json(study->owner));
    (void)json_object_set_new(
        view, "cancel_requested",
        json_boolean(study->cancel_requested && study->state == STUDY_RUNNING));
    (void)json_object_set_new(view, "revision", json_integer(study->revision));
    (void)json_object_set_new(view, "created_at", text_json(study->created_at));
    (void)json_object_set_new(view, "finished_at", text_json(study->finished_at));
    (void)json_object_set_new(view, "counts", counts_json(study));
    (void)json_object_set_new(view, "progress", progress_json(service, study));
    (void)json_object_set_new(view, "parameters", document_json(study->names, "[]"));
    (void)json_object_set_new(view, "metrics", document_json(study->metrics, "[]"));
    (void)json_object_set_new(view, "chart", document_json(study->chart, "null"));
    (void)json_object_set_new(view, "reuse", json_boolean(study->reuse));
    (void)json_object_set_new(view, "forecast", document_json(study->forecast, "null"));
    (void)json_object_set_new(view, "advice", document_json(study->advice, "[]"));
    (void)json_object_set_new(view, "result", document_json(study->result, "null"));
    (void)json_object_set_new(view, "links", links_json(study));
    if (study->scene != NULL)
        (void)json_object_set_new(view, "scene", document_json(study->scene, "null"));
    if (study->design != NULL)
        (void)json_object_set_new(view, "design", document_json(study->design, "null"));
    return view;
}

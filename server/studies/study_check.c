/* SPDX-License-Identifier: Apache-2.0 */
/* All scenes of a study are checked before it is accepted: many in one question to a helper, and no
 * more than it answers in good time. */
#include "json_pointer.h"
#include "moment.h"
#include "reply.h"
#include "scene_question.h"
#include "studies/study_draft.h"
#include "studies/study_metric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH_FIRST = 16, BATCH_MAX = 1024, MISTAKEN_ROWS_MAX = 10 };

/* A batch grows while an answer takes less than this share of the time it may take, and shrinks
 * when it takes more than the other. */
static const double share_small = 0.125, share_large = 0.5;

struct check {
    struct study_draft *draft;
    struct service *service;
    struct helper *helper;
    json_t *errors;
    size_t next, batch; /* the first row that is not checked, rows in a question */
    size_t mistaken;    /* rows */
};

static const json_t *row_at(const struct study_draft *draft, size_t index)
{
    return json_array_get(draft->rows, index);
}

/* Adds an issue of a row, which it names. `found` has pointer (into the scene), code and detail. */
static void row_issue(const struct check *check, size_t row, const json_t *found)
{
    const json_t *parameters = json_object_get(row_at(check->draft, row), "parameters");
    const char *pointer = json_string_value(json_object_get(found, "pointer"));
    const char *detail = json_string_value(json_object_get(found, "detail"));
    char *shown = json_dumps(parameters, JSON_COMPACT | JSON_REAL_PRECISION(6));
    json_t *issue = json_copy((json_t *)(uintptr_t)found);
    (void)json_object_set_new(issue, "pointer",
                              json_sprintf("/scene%s", pointer == NULL ? "" : pointer));
    (void)json_object_set_new(issue, "row", json_integer((json_int_t)row));
    (void)json_object_set(issue, "parameters", (json_t *)(uintptr_t)parameters);
    (void)json_object_set_new(issue, "detail",
                              json_sprintf("row %zu %.200s: %s", row, shown == NULL ? "" : shown,
                                           detail == NULL ? "" : detail));
    (void)json_array_append_new(check->errors, issue);
    free(shown);
}

static void row_refused(struct check *check, size_t row, const json_t *answer)
{
    size_t index;
    const json_t *found;
    check->mistaken++;
    json_array_foreach(json_object_get(answer, "errors"), index, found)
    {
        row_issue(check, row, found);
    }
}

static void row_simple_issue(struct check *check, size_t row, const char *code, const char *detail)
{
    json_t *answer =
        json_pack("{s:[{s:s, s:s, s:s}]}", "errors", "pointer", "", "code", code, "detail", detail);
    row_refused(check, row, answer);
    json_decref(answer);
}

/* Adds a row to the sums, unless a job with its result is there. */
static enum talus_status row_count(struct check *check, const json_t *answer,
                                   struct talus_error *error)
{
    static const char *const ends[] = {"low", "expected", "high"};
    struct study_totals *totals = &check->draft->totals;
    const json_t *forecast = json_object_get(answer, "forecast");
    const json_t *wall = json_object_get(forecast, "wall_seconds");
    const char *hash = json_string_value(json_object_get(answer, "hash"));
    const char *build = json_string_value(json_object_get(answer, "build"));
    char found[64] = "";
    totals->rows++;
    if (check->draft->study.reuse && hash != NULL && build != NULL &&
        store_job_find_finished(check->service->store, hash, build, found, error) != TALUS_OK)
        return TALUS_IO;
    if (found[0] != '\0') {
        totals->reused++;
        return TALUS_OK;
    }
    totals->steps += json_number_value(json_object_get(forecast, "steps"));
    totals->disk += json_number_value(json_object_get(forecast, "disk_bytes"));
    totals->memory =
        fmax(totals->memory, json_number_value(json_object_get(forecast, "memory_bytes")));
    for (size_t index = 0; index < 3; index++) {
        double seconds = json_number_value(json_object_get(wall, ends[index]));
        totals->wall[index] += seconds;
        totals->longest[index] = fmax(totals->longest[index], seconds);
    }
    return TALUS_OK;
}

static json_t *question_make(const struct check *check, size_t count)
{
    json_t *scenes = json_array();
    const json_int_t given = check->draft->threads;
    const json_int_t most = given > 0 ? given : (json_int_t)check->service->config->workers;
    for (size_t index = check->next; index < check->next + count; index++) {
        const json_t *set = json_object_get(row_at(check->draft, index), "set");
        if (json_array_append_new(scenes, study_scene(check->draft->scene, set)) != 0) {
            json_decref(scenes);
            return NULL;
        }
    }
    return json_pack("{s:s, s:o, s:I, s:i, s:o}", "op", "check_many", "scenes", scenes, "threads",
                     most, "stop_after", MISTAKEN_ROWS_MAX, "calibration",
                     scene_question_calibration(check->service, given));
}

static enum talus_status answers_take(struct check *check, const json_t *answers,
                                      struct talus_error *error)
{
    size_t index;
    const json_t *answer;
    enum talus_status status = TALUS_OK;
    json_array_foreach(answers, index, answer)
    {
        if (!json_is_true(json_object_get(answer, "ok")))
            row_refused(check, check->next, answer);
        else if (status == TALUS_OK)
            status = row_count(check, answer, error);
        check->next++;
    }
    return status;
}

/* One question. */
static enum talus_status batch_check(struct check *check, struct talus_error *error)
{
    double seconds = check->service->config->helper_seconds, begin = moment_monotonic();
    size_t left = json_array_size(check->draft->rows) - check->next;
    size_t count = left < check->batch ? left : check->batch;
    json_t *answer = NULL, *question = question_make(check, count);
    enum talus_status status = question == NULL
                                   ? talus_error_memory(error)
                                   : helper_ask(check->helper, question, seconds, &answer, error);
    json_decref(question);
    if (status == TALUS_OK) {
        const json_t *answers = json_object_get(answer, "answers");
        status = json_array_size(answers) == 0
                     ? talus_error_set(error, TALUS_IO, "helper", "",
                                       "the worker program does not check rows")
                     : answers_take(check, answers, error);
        double share = (moment_monotonic() - begin) / seconds;
        if (share < share_small && check->batch < BATCH_MAX)
            check->batch *= 2;
        else if (share > share_large && check->batch > 1)
            check->batch /= 2;
    } else if (count > 1 && (status == TALUS_LIMIT || status == TALUS_IO)) {
        /* One of them is too much; it is found by asking for fewer. */
        check->batch = (count + 3) / 4;
        status = TALUS_OK;
    } else if (status == TALUS_LIMIT) {
        row_simple_issue(check, check->next++, "too_costly", error->text);
        status = TALUS_OK;
    }
    json_decref(answer);
    return status;
}

/* Whether some row changes what a section of the scene names. */
static bool section_varies(const json_t *row)
{
    static const char *const sections[] = {"/probes", "/boundaries", "/references"};
    const char *pointer;
    const json_t *value;
    json_object_foreach(json_object_get(row, "set"), pointer, value)
    {
        for (size_t index = 0; index < sizeof sections / sizeof sections[0]; index++) {
            if (json_pointer_is_within(pointer, sections[index]))
                return true;
        }
    }
    return false;
}

static void metrics_check(const struct check *check, const json_t *effective)
{
    const struct study_draft *draft = check->draft;
    json_t *asked = json_loads(draft->study.metrics, 0, NULL);
    if (section_varies(row_at(draft, 0)))
        effective = NULL;
    for (size_t index = 0; index < json_array_size(draft->wanted); index++) {
        json_t *pointer = index < json_array_size(asked) ? json_sprintf("/metrics/%zu", index)
                                                         : json_string("/design");
        study_metric_check(json_string_value(json_array_get(draft->wanted, index)), effective,
                           json_string_value(pointer), check->errors);
        json_decref(pointer);
    }
    json_decref(asked);
}

/* Looks at the first row as at a job: its advice, and whether its scene has the metrics. */
static enum talus_status first_check(struct check *check, struct talus_error *error)
{
    struct study_draft *draft = check->draft;
    json_t *answer = NULL;
    json_t *scene = study_scene(draft->scene, json_object_get(row_at(draft, 0), "set"));
    json_t *question = scene == NULL ? NULL : scene_question(check->service, scene, 1);
    json_decref(scene);
    enum talus_status status =
        question == NULL ? talus_error_memory(error)
                         : helper_ask(check->helper, question,
                                      check->service->config->helper_seconds, &answer, error);
    json_decref(question);
    if (status == TALUS_OK && json_is_true(json_object_get(answer, "ok"))) {
        draft->advice = json_incref(json_object_get(answer, "advice"));
        metrics_check(check, json_object_get(answer, "effective"));
    } else if (status == TALUS_LIMIT) {
        status = TALUS_OK; /* the check of all rows finds it again */
    }
    json_decref(answer);
    return status;
}

static json_t *interval_json(const double seconds[3])
{
    return json_pack("{s:f, s:f, s:f}", "low", seconds[0], "expected", seconds[1], "high",
                     seconds[2]);
}

static enum talus_status forecast_write(struct study_draft *draft, double workers,
                                        struct talus_error *error)
{
    struct study_totals *totals = &draft->totals;
    double threads = draft->threads < 1 ? 1 : (double)draft->threads, elapsed[3];
    if (draft->plan.kind == STUDY_BISECT) {
        double scale = (double)draft->study.rows_expected / (double)json_array_size(draft->rows);
        totals->rows *= scale;
        totals->steps *= scale;
        totals->disk *= scale;
        for (size_t index = 0; index < 3; index++)
            totals->wall[index] *= scale;
    }
    /* A search runs its rows one after another, but for the two ends. */
    double at_once = fmax(1, floor(workers / threads));
    if (draft->plan.kind == STUDY_BISECT)
        at_once = fmin(at_once, (double)json_array_size(draft->plan.rows));
    for (size_t index = 0; index < 3; index++)
        elapsed[index] = fmax(totals->longest[index], totals->wall[index] / at_once);
    json_t *forecast =
        json_pack("{s:I, s:I, s:f, s:f, s:f, s:o, s:o}", "rows", (json_int_t)totals->rows, "reused",
                  (json_int_t)totals->reused, "steps", totals->steps, "memory_bytes",
                  totals->memory, "disk_bytes", totals->disk, "wall_seconds",
                  interval_json(totals->wall), "elapsed_seconds", interval_json(elapsed));
    enum talus_status status = job_json_set(&draft->study.forecast, forecast, error);
    json_decref(forecast);
    return status == TALUS_OK ? job_json_set(&draft->study.advice, draft->advice, error) : status;
}

enum talus_status study_draft_check(struct study_draft *draft, struct service *service,
                                    struct helper *helper, json_t *errors,
                                    struct talus_error *error)
{
    struct check check = {.draft = draft,
                          .service = service,
                          .helper = helper,
                          .errors = errors,
                          .batch = BATCH_FIRST};
    size_t count = json_array_size(draft->rows);
    enum talus_status status = first_check(&check, error);
    while (status == TALUS_OK && check.next < count && check.mistaken < MISTAKEN_ROWS_MAX)
        status = batch_check(&check, error);
    return status == TALUS_OK ? forecast_write(draft, service->config->workers, error) : status;
}

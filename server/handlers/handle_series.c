/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/jobs/ID/series[/NAME] */
#include "conditional.h"
#include "decimate.h"
#include "history_reader.h"
#include "request.h"
#include "schemas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS_MAX = 1000000, BLOCK_ROWS = 4096 };

/* A curve that grows; owns its arrays. */
struct curve {
    double *time, *value;
    size_t count, capacity;
    bool failed;
};

static void curve_release(struct curve *curve)
{
    free(curve->time);
    free(curve->value);
}

static void curve_add(struct curve *curve, double time, double value)
{
    if (curve->count == curve->capacity) {
        size_t capacity = curve->capacity == 0 ? 1024 : 2 * curve->capacity;
        double *times = realloc(curve->time, capacity * sizeof *times);
        if (times != NULL)
            curve->time = times;
        double *values = realloc(curve->value, capacity * sizeof *values);
        if (values != NULL)
            curve->value = values;
        curve->failed = times == NULL || values == NULL;
        if (curve->failed)
            return;
        curve->capacity = capacity;
    }
    curve->time[curve->count] = time;
    curve->value[curve->count++] = value;
}

/* The rows of a column within [from, to]. */
static void curve_read(struct curve *curve, const struct history_reader *history, size_t column,
                       double from, double to)
{
    int64_t rows = history_reader_row_count(history);
    double *block = malloc(BLOCK_ROWS * history->column_count * sizeof *block);
    curve->failed = block == NULL;
    for (int64_t first = 0; first < rows && !curve->failed; first += BLOCK_ROWS) {
        size_t wanted = rows - first < BLOCK_ROWS ? (size_t)(rows - first) : BLOCK_ROWS;
        size_t count = history_reader_read(history, first, wanted, block);
        for (size_t row = 0; row < count && !curve->failed; row++) {
            const double *values = block + row * history->column_count;
            if (values[0] >= from && values[0] <= to)
                curve_add(curve, values[0], values[column]);
        }
        if (count < wanted)
            break;
    }
    free(block);
}

static void array_print(struct text *text, const double *values, size_t count)
{
    text_add_string(text, "[");
    /* An empty curve has no array. */
    for (size_t index = 0; values != NULL && index < count; index++) {
        text_add_string(text, index == 0 ? "" : ",");
        text_add_number(text, values[index]);
    }
    text_add_string(text, "]");
}

static void curve_print_json(struct text *text, const struct curve *curve,
                             const struct history_column *column, bool decimated)
{
    json_t *head = json_pack("{s:s, s:s}", "name", column->name, "unit", column->unit);
    char *dump = head == NULL ? NULL : json_dumps(head, JSON_COMPACT);
    if (dump == NULL) {
        text->failed = true;
    } else {
        text_add(text, dump, strlen(dump) - 1);
        text_add_string(text, ",\"time\":");
        array_print(text, curve->time, curve->count);
        text_add_string(text, ",\"value\":");
        array_print(text, curve->value, curve->count);
        text_print(text, ",\"decimated\":%s}\n", decimated ? "true" : "false");
    }
    free(dump);
    json_decref(head);
}

static void curve_print_csv(struct text *text, const struct curve *curve,
                            const struct history_column *column)
{
    const double *time = curve->time, *value = curve->value;
    text_print(text, "time,%s\r\n", column->name);
    for (size_t index = 0; time != NULL && value != NULL && index < curve->count; index++) {
        text_add_number(text, time[index]);
        text_add_string(text, ",");
        if (isfinite(value[index]))
            text_add_number(text, value[index]);
        text_add_string(text, "\r\n");
    }
}

/* Opens the history of the job in the path. False: the reply is made. */
static bool history_of_request(struct request *request, struct history_reader *history)
{
    struct talus_error error = {0};
    char *folder = request_folder(request);
    if (folder == NULL)
        return false;
    enum talus_status status = history_reader_open(history, folder, &error);
    free(folder);
    if (status != TALUS_OK)
        reply_error(&request->reply, request->raw, &error);
    return status == TALUS_OK;
}

const struct operation operation_series_list = {
    .summary = "The names of the histories of a job",
    .path = operation_job_path,
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_series_list,
                                            .headers = conditional_headers,
                                            .meaning = "all histories"},
                                           CONDITIONAL_UNCHANGED,
                                           RESPONSE_END},
    .problems = conditional_problems,
};

enum handled handle_series_list(struct request *request)
{
    struct history_reader history;
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    struct talus_error error = {0};
    json_t *list = json_array();
    if (history_reader_open(&history, folder, &error) == TALUS_OK) {
        json_int_t rows = history_reader_row_count(&history);
        for (size_t index = 1; index < history.column_count; index++)
            (void)json_array_append_new(list, json_pack("{s:s, s:s, s:I}", "name",
                                                        history.columns[index].name, "unit",
                                                        history.columns[index].unit, "rows", rows));
        history_reader_close(&history);
    }
    free(folder);
    conditional_document(request, "application/json", list);
    return HANDLED;
}

static void series_reply(struct request *request, const struct history_reader *history,
                         size_t column, const double limits[3])
{
    struct curve curve = {0};
    struct text text = {0};
    size_t max_points = (size_t)limits[2];
    const char *accept = request_header(request, MHD_HTTP_HEADER_ACCEPT);
    bool csv = accept != NULL && strstr(accept, "text/csv") != NULL;
    curve_read(&curve, history, column, limits[0], limits[1]);
    size_t before = curve.count;
    curve.count = decimate(curve.time, curve.value, curve.count, max_points);
    text.failed = curve.failed;
    if (csv)
        curve_print_csv(&text, &curve, &history->columns[column]);
    else
        curve_print_json(&text, &curve, &history->columns[column], curve.count < before);
    char etag[CONDITIONAL_ETAG_SIZE];
    conditional_etag(text.failed ? "" : text.data, text.failed ? 0 : text.length, etag);
    if (conditional_reply(request, etag)) {
        text_release(&text);
        curve_release(&curve);
        return;
    }
    reply_text(&request->reply, MHD_HTTP_OK,
               csv ? "text/csv; charset=utf-8; header=present" : "application/json", &text);
    reply_header(&request->reply, MHD_HTTP_HEADER_VARY, "Accept");
    reply_header(&request->reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
    conditional_mark(request, etag);
    curve_release(&curve);
}

static const char *const series_headers[] = {"ETag", "Vary", NULL};

const struct operation operation_series = {
    .summary = "A history of a job so far",
    .path = (const struct json_field[]){{.key = "id", .meaning = "of the job"},
                                        {.key = "name",
                                         .meaning = "of the history: reaction.floor.force.y, "
                                                    "probe.runout, energy.kinetic, ..."},
                                        OPERATION_END},
    .query = (const struct json_field[]){{.key = "from",
                                          .kind = FIELD_NUMBER,
                                          .optional = true,
                                          .preset = -HUGE_VAL,
                                          .meaning = "[s] nothing before"},
                                         {.key = "to",
                                          .kind = FIELD_NUMBER,
                                          .optional = true,
                                          .preset = HUGE_VAL,
                                          .meaning = "[s] nothing after"},
                                         {.key = "max_points",
                                          .kind = FIELD_INTEGER,
                                          .optional = true,
                                          .minimum = 4,
                                          .maximum = POINTS_MAX,
                                          .preset = POINTS_MAX,
                                          .meaning = "thinned to so many points at most; the "
                                                     "extremes stay"},
                                         OPERATION_END},
    .responses =
        (const struct response[]){
            {.status = 200,
             .type = "application/json",
             .schema = &schema_series,
             .headers = series_headers,
             .meaning = "the history; as text/csv: a line with the names, then time and value"},
            {.status = 200, .type = "text/csv", .headers = series_headers, .meaning = ""},
            CONDITIONAL_UNCHANGED,
            RESPONSE_END},
    .problems = conditional_problems,
};

enum handled handle_series(struct request *request)
{
    struct history_reader history;
    const double limits[3] = {request_query_number(request, "from"),
                              request_query_number(request, "to"),
                              request_query_number(request, "max_points")};
    if (!history_of_request(request, &history))
        return HANDLED;
    size_t column = history_reader_find(&history, request->rest);
    if (column == 0 || column == history.column_count)
        reply_problem(&request->reply, MHD_HTTP_NOT_FOUND, "not_found", request->raw, NULL,
                      "the job has no series %s", request->rest);
    else
        series_reply(request, &history, column, limits);
    history_reader_close(&history);
    return HANDLED;
}

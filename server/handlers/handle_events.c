/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/jobs/ID/events, /v1/studies/ID/events and /v1/events */
#include "events.h"
#include "request.h"
#include "service.h"
#include "studies/study_request.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const struct json_field after_or_latest[] = {
    {.key = "after",
     .kind = FIELD_TEXT,
     .optional = true,
     .meaning = "id of the event behind which to go on; 'latest': only what happens from now on"},
    OPERATION_END};

static const struct json_field last_event_headers[] = {{.key = "Last-Event-ID",
                                                        .kind = FIELD_TEXT,
                                                        .optional = true,
                                                        .meaning = "the same, as browsers send it"},
                                                       OPERATION_END};

/* The id behind which the reader wants to go on, or NULL. */
static const char *event_id_given(const struct request *request)
{
    const char *id = request_header(request, "Last-Event-ID");
    return id != NULL ? id : target_query(&request->target, "after");
}

static void refuse_event_id(struct request *request, const char *detail)
{
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "event_id", request->raw, NULL,
                  "%s", detail);
}

static const char no_event_id[] = "this is not the id of an event";

#define EVENT_STREAM(events)                                                                       \
    {                                                                                              \
        .status = 200, .type = "text/event-stream", .meaning = (events)                            \
    }
#define NOTHING_LEFT                                                                               \
    {                                                                                              \
        .status = 204, .meaning = "nothing is left to tell, now or ever"                           \
    }

const struct operation operation_job_events = {
    .summary = "What happens to a job, from its start, as Server-Sent Events",
    .path = operation_job_path,
    .query = (const struct json_field[]){{.key = "after",
                                          .kind = FIELD_TEXT,
                                          .optional = true,
                                          .meaning = "id of the event behind which to go on"},
                                         OPERATION_END},
    .headers = last_event_headers,
    .responses =
        (const struct response[]){
            EVENT_STREAM("events state, progress, reaction, probe, energy, frame, warning, log, "
                         "rewind, gap, done; the last ends the stream"),
            NOTHING_LEFT, RESPONSE_END},
};

/* Tells a browser's EventSource not to connect again. */
static void reply_nothing_left(struct request *request)
{
    reply_empty(&request->reply, MHD_HTTP_NO_CONTENT);
    request->reply.close = true;
}

enum handled handle_job_events(struct request *request)
{
    struct talus_error error = {0};
    struct event_source source = {0};
    struct event_stream *stream = &source.stream;
    struct event_id after = {0};
    const char *id = event_id_given(request);
    if (id != NULL && id[0] != '\0' && !event_id_parse(id, &after)) {
        refuse_event_id(request, no_event_id);
        return HANDLED;
    }
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    if (event_stream_open(stream, folder, after, &error) != TALUS_OK) {
        if (error.status == TALUS_INVALID)
            refuse_event_id(request, error.text);
        else
            reply_error(&request->reply, request->raw, &error);
    } else {
        (void)event_stream_fill(stream);
        if (stream->done && stream->out.length == 0) {
            reply_nothing_left(request);
            event_stream_close(stream);
        } else {
            events_subscribe(request->service->events, request, &source);
        }
    }
    free(folder);
    return HANDLED;
}

/* The row behind which the reader wants to go on, as "ROW" or "latest". */
static bool row_parse(struct feed *feed, const char *text, int64_t *row)
{
    char *end = NULL;
    *row = 0;
    if (text == NULL || text[0] == '\0')
        return true;
    if (strcmp(text, "latest") == 0) {
        *row = feed_last(feed);
        return true;
    }
    errno = 0;
    *row = strtoll(text, &end, 10);
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0 &&
           *row <= feed_last(feed);
}

/* False: the reply is made. */
static bool row_read(struct request *request, int64_t *row)
{
    if (row_parse(events_feed(request->service->events), event_id_given(request), row))
        return true;
    refuse_event_id(request, no_event_id);
    return false;
}

const struct operation operation_study_events = {
    .summary = "What happens to a study and its rows, from its start, as Server-Sent Events",
    .path = operation_study_path,
    .query = after_or_latest,
    .headers = last_event_headers,
    .responses =
        (const struct response[]){
            EVENT_STREAM("events state of the study, row of its rows, gap, done; the last ends "
                         "the stream"),
            NOTHING_LEFT, RESPONSE_END},
};

enum handled handle_study_events(struct request *request)
{
    struct event_source source = {.kind = SOURCE_STUDY};
    struct study_stream *stream = &source.study;
    struct study study;
    int64_t row;
    if (!row_read(request, &row) || !study_request_read(request, false, &study))
        return HANDLED;
    study_stream_open(stream, request->service->store, study.id, row);
    study_stream_fill(stream);
    if (study.state != STUDY_RUNNING && stream->out.length == 0) {
        study_stream_close(stream);
        reply_nothing_left(request);
    } else {
        events_subscribe(request->service->events, request, &source);
    }
    study_release(&study);
    return HANDLED;
}

const struct operation operation_events = {
    .summary = "What happens to all jobs and studies, as Server-Sent Events",
    .query = after_or_latest,
    .headers = last_event_headers,
    .responses =
        (const struct response[]){
            EVENT_STREAM("events state and done of jobs, study of studies, with growing ids; "
                         "progress of running jobs without one, which is not told again; gap"),
            RESPONSE_END},
};

enum handled handle_events(struct request *request)
{
    struct feed *feed = events_feed(request->service->events);
    struct event_source source = {.kind = SOURCE_ALL};
    int64_t row;
    if (!row_read(request, &row))
        return HANDLED;
    feed_reader_open(&source.reader, feed, row);
    events_subscribe(request->service->events, request, &source);
    return HANDLED;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "event_stream.h"

#include "base/protocol.h"
#include "folder.h"
#include "job.h"
#include "json_text.h"

#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OUT_BYTES = 64 << 10, CHUNK_ROWS = 512 };

/* Behind every event of a line. */
static const uint64_t number_of_gap = UINT32_MAX;

bool event_id_parse(const char *text, struct event_id *id)
{
    char *end = NULL;
    if (text[0] < '0' || text[0] > '9')
        return false;
    errno = 0;
    long long offset = strtoll(text, &end, 10);
    if (errno != 0 || *end != '-' || end[1] < '0' || end[1] > '9')
        return false;
    id->offset = offset;
    id->number = strtoull(end + 1, &end, 10);
    return errno == 0 && *end == '\0';
}

static bool id_known(const struct event_stream *stream, struct event_id id)
{
    return id.offset < stream->after.offset ||
           (id.offset == stream->after.offset && id.number <= stream->after.number &&
            stream->after.offset > 0);
}

/* Begins an event; the data and two line ends follow. */
static void event_begin(struct event_stream *stream, struct event_id id, const char *event)
{
    struct text *out = &stream->out;
    text_add_string(out, "id: ");
    text_add_integer(out, id.offset);
    text_add_string(out, "-");
    text_add_integer(out, (int64_t)id.number);
    text_add_string(out, "\nevent: ");
    text_add_string(out, event);
    text_add_string(out, "\ndata: ");
    stream->last = id;
}

static void event_write(struct event_stream *stream, struct event_id id, const char *event,
                        const char *data)
{
    if (id_known(stream, id))
        return;
    event_begin(stream, id, event);
    text_add_string(&stream->out, data);
    text_add_string(&stream->out, "\n\n");
}

struct survey {
    struct event_stream *stream;
    bool on_line; /* `after` is the end of a line */
    bool failed;
};

static bool survey_line(char *line, size_t length, int64_t end, void *context)
{
    struct survey *survey = context;
    struct event_stream *stream = survey->stream;
    json_t *root = json_loadb(line, length, 0, NULL);
    const char *name = json_string_value(json_object_get(root, "event"));
    enum protocol_message message =
        name == NULL ? PROTOCOL_MESSAGE_COUNT : protocol_message_find(name);
    survey->on_line = survey->on_line || end == stream->after.offset;
    if (message == PROTOCOL_PROGRESS)
        stream->last_progress = end;
    if (message == PROTOCOL_REWIND) {
        struct event_rewind *rewinds =
            realloc(stream->rewinds, (stream->rewind_count + 1) * sizeof *rewinds);
        if (rewinds == NULL) {
            survey->failed = true;
        } else {
            stream->rewinds = rewinds;
            rewinds[stream->rewind_count++] = (struct event_rewind){
                .end = end, .row = json_integer_value(json_object_get(root, "row"))};
        }
    }
    json_decref(root);
    return !survey->failed;
}

enum talus_status event_stream_open(struct event_stream *stream, const char *folder,
                                    struct event_id after, struct talus_error *error)
{
    memset(stream, 0, sizeof *stream);
    stream->tail.descriptor = -1;
    stream->history.descriptor = -1;
    stream->after = after;
    stream->last = after;
    stream->folder = strdup(folder);
    struct survey survey = {.stream = stream, .on_line = after.offset == 0};
    struct event_tail tail = {.descriptor = -1};
    enum talus_status status = TALUS_OK;
    if (stream->folder != NULL)
        status = event_tail_read(&tail, folder, survey_line, &survey, error);
    stream->replay_end = tail.offset;
    event_tail_close(&tail);
    if (status == TALUS_OK && (survey.failed || stream->folder == NULL))
        status = talus_error_memory(error);
    if (status == TALUS_OK && !survey.on_line)
        status = talus_error_set(error, TALUS_INVALID, "event_id", "",
                                 "no event of this job has the id %" PRId64 "-%" PRIu64,
                                 after.offset, after.number);
    if (status != TALUS_OK)
        event_stream_close(stream);
    return status;
}

static const char *series_event(const char *name)
{
    if (strncmp(name, "reaction.", 9) == 0)
        return "reaction";
    return strncmp(name, "energy.", 7) == 0 ? "energy" : "probe";
}

/* A column of rows as the members of a JSON array. */
static void numbers_add(struct text *text, const double *values, size_t row_count, size_t stride)
{
    for (size_t row = 0; row < row_count; row++) {
        if (row > 0)
            text_add(text, ",", 1);
        text_add_number(text, values[row * stride]);
    }
}

/* One column of some rows as {"name","time","value"}; `times` is the text of the times. */
static void column_write(struct event_stream *stream, struct event_id id, size_t column,
                         const struct text *times, const double *values, size_t row_count)
{
    const struct history_reader *history = &stream->history;
    if (id_known(stream, id))
        return;
    struct text *out = &stream->out;
    event_begin(stream, id, series_event(history->columns[column].name));
    text_add_string(out, "{\"name\":");
    json_text_add_string(out, history->columns[column].name);
    text_add_string(out, ",\"time\":[");
    text_add(out, times->data, times->length);
    text_add_string(out, "],\"value\":[");
    numbers_add(out, values + column, row_count, history->column_count);
    text_add_string(out, "]}\n\n");
}

/* Tells the next chunk of the rows that a history line announced. */
static void span_step(struct event_stream *stream)
{
    struct history_reader *history = &stream->history;
    int64_t left = stream->span_end - stream->span_row;
    size_t wanted = left < CHUNK_ROWS ? (size_t)left : CHUNK_ROWS;
    double *values = malloc(wanted * history->column_count * sizeof *values);
    size_t count =
        values == NULL ? 0 : history_reader_read(history, stream->span_row, wanted, values);
    struct event_id id = stream->span_next;
    struct text times = {0};
    numbers_add(&times, values, count, history->column_count);
    if (times.failed)
        stream->out.failed = true;
    for (size_t column = 1; column < history->column_count && times.length > 0;
         column++, id.number++)
        column_write(stream, id, column, &times, values, count);
    text_release(&times);
    free(values);
    /* Rows that a resume has cut since are void: a rewind follows. */
    stream->span_row = count < wanted ? stream->span_end : stream->span_row + (int64_t)count;
    stream->span_next.number += history->column_count - 1;
}

static void history_line(struct event_stream *stream, const json_t *root, int64_t end)
{
    struct talus_error error = {0};
    int64_t rows = json_integer_value(json_object_get(root, "rows"));
    int64_t first = stream->row, last = rows;
    stream->row = rows;
    for (size_t index = 0; index < stream->rewind_count; index++) {
        if (stream->rewinds[index].end > end && stream->rewinds[index].row < last)
            last = stream->rewinds[index].row;
    }
    if (stream->mute || last <= first || end < stream->after.offset)
        return;
    if (stream->history.descriptor < 0 &&
        history_reader_open(&stream->history, stream->folder, &error) != TALUS_OK)
        return;
    stream->span_row = first;
    stream->span_end = last;
    stream->span_next = (struct event_id){.offset = end, .number = 0};
}

static void state_line(struct event_stream *stream, const json_t *root, const char *line,
                       int64_t end)
{
    const char *name = json_string_value(json_object_get(root, "state"));
    enum job_state state = name == NULL ? JOB_STATE_COUNT : job_state_find(name);
    free(stream->final_line);
    stream->final_line = state != JOB_STATE_COUNT && job_state_final(state) ? strdup(line) : NULL;
    stream->final_end = end;
}

static void rewind_line(struct event_stream *stream, const json_t *root)
{
    stream->row = json_integer_value(json_object_get(root, "row"));
    /* A resumed attempt may have replaced the file. */
    history_reader_close(&stream->history);
}

/* Whether a line is told as it stands. */
static bool line_told(const struct event_stream *stream, enum protocol_message message, int64_t end)
{
    switch (message) {
    case PROTOCOL_STATE:
    case PROTOCOL_REWIND:
        return true;
    case PROTOCOL_PROGRESS:
        return !stream->mute && (end > stream->replay_end || end == stream->last_progress);
    case PROTOCOL_FRAME:
    case PROTOCOL_WARNING:
    case PROTOCOL_LOG:
        return !stream->mute;
    default:
        return false;
    }
}

static bool stream_line(char *line, size_t length, int64_t end, void *context)
{
    struct event_stream *stream = context;
    json_t *root = json_loadb(line, length, 0, NULL);
    const char *name = json_string_value(json_object_get(root, "event"));
    enum protocol_message message =
        name == NULL ? PROTOCOL_MESSAGE_COUNT : protocol_message_find(name);
    const struct event_id id = {.offset = end, .number = 0};
    if (message != PROTOCOL_STATE) {
        free(stream->final_line);
        stream->final_line = NULL;
    }
    if (line_told(stream, message, end))
        event_write(stream, id, protocol_message_name(message), line);
    if (message == PROTOCOL_STATE)
        state_line(stream, root, line, end);
    else if (message == PROTOCOL_HISTORY)
        history_line(stream, root, end);
    else if (message == PROTOCOL_REWIND)
        rewind_line(stream, root);
    json_decref(root);
    return stream->span_row >= stream->span_end && stream->out.length < OUT_BYTES;
}

bool event_stream_fill(struct event_stream *stream)
{
    struct talus_error error = {0};
    while (!stream->done && stream->out.length < OUT_BYTES) {
        if (stream->span_row < stream->span_end) {
            span_step(stream);
            continue;
        }
        int64_t before = stream->tail.offset;
        if (event_tail_read(&stream->tail, stream->folder, stream_line, stream, &error) != TALUS_OK)
            return false;
        if (stream->tail.offset > before || stream->span_row < stream->span_end)
            continue;
        if (stream->final_line != NULL) {
            const struct event_id id = {.offset = stream->final_end, .number = 1};
            event_write(stream, id, "done", stream->final_line);
            stream->done = true;
        }
        return false;
    }
    return !stream->done;
}

void event_stream_skip(struct event_stream *stream)
{
    struct talus_error error = {0};
    struct event_id from = stream->last;
    char data[128];
    stream->span_row = stream->span_end;
    stream->mute = true;
    int64_t before;
    do {
        before = stream->tail.offset;
        if (event_tail_read(&stream->tail, stream->folder, stream_line, stream, &error) != TALUS_OK)
            break;
    } while (stream->tail.offset > before);
    stream->mute = false;
    (void)snprintf(data, sizeof data, "{\"after\":\"%" PRId64 "-%" PRIu64 "\"}", from.offset,
                   from.number);
    const struct event_id id = {.offset = stream->tail.offset, .number = number_of_gap};
    event_write(stream, id, "gap", data);
}

int64_t event_stream_backlog(const struct event_stream *stream)
{
    struct stat information;
    int descriptor = folder_open(stream->folder, PROTOCOL_EVENTS_FILE);
    bool known = descriptor >= 0 && fstat(descriptor, &information) == 0;
    if (descriptor >= 0)
        (void)close(descriptor);
    return known ? (int64_t)information.st_size - stream->tail.offset : 0;
}

void event_stream_close(struct event_stream *stream)
{
    event_tail_close(&stream->tail);
    history_reader_close(&stream->history);
    free(stream->folder);
    free(stream->rewinds);
    free(stream->final_line);
    text_release(&stream->out);
    memset(stream, 0, sizeof *stream);
    stream->tail.descriptor = stream->history.descriptor = -1;
}

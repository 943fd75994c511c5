/* SPDX-License-Identifier: Apache-2.0 */
#include "studies/study_stream.h"

#include "studies/study_store.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OUT_BYTES = 64 << 10 };
static const int64_t event_bytes = 200; /* about, for a backlog */

void study_stream_open(struct study_stream *stream, struct store *store, const char *id,
                       int64_t after)
{
    memset(stream, 0, sizeof *stream);
    stream->store = store;
    stream->row = after;
    (void)snprintf(stream->id, sizeof stream->id, "%s", id);
}

static bool transition_tell(const struct study_transition *transition, void *context)
{
    struct study_stream *stream = context;
    bool whole = transition->number < 0;
    json_t *members =
        whole ? json_pack("{s:s}", "study", stream->id)
              : json_pack("{s:s, s:I}", "study", stream->id, "row", (json_int_t)transition->number);
    json_t *rest =
        json_pack("{s:s, s:s, s:s*, s:s*}", "at", transition->at, "state", transition->state, "job",
                  transition->job, "detail", transition->detail);
    if (rest != NULL)
        (void)json_object_update(members, rest);
    char *data = json_dumps(members, JSON_COMPACT);
    text_print(&stream->out, "id: %" PRId64 "\nevent: %s\ndata: %s\n\n", transition->row,
               whole ? "state" : "row", data == NULL ? "{}" : data);
    stream->row = transition->row;
    stream->done = whole && study_state_find(transition->state) != STUDY_RUNNING;
    if (stream->done)
        text_print(&stream->out, "id: %" PRId64 "\nevent: done\ndata: %s\n\n", transition->row,
                   data == NULL ? "{}" : data);
    free(data);
    json_decref(rest);
    json_decref(members);
    stream->paused = stream->out.length >= OUT_BYTES;
    return !stream->done && !stream->paused;
}

/* Whether a study is there no more. */
static bool study_gone(const struct study_stream *stream)
{
    struct study study = {0};
    struct talus_error error = {0};
    enum talus_status status = study_store_read(stream->store, stream->id, false, &study, &error);
    study_release(&study);
    return status == TALUS_INVALID;
}

void study_stream_fill(struct study_stream *stream)
{
    struct talus_error error = {0};
    uint64_t commits = store_commit_count(stream->store);
    if (stream->done || (stream->looked && !stream->paused && commits == stream->commits))
        return;
    int64_t before = stream->row;
    stream->paused = false;
    stream->looked = study_store_transitions(stream->store, stream->id, stream->row,
                                             transition_tell, stream, &error) == TALUS_OK;
    stream->commits = commits;
    /* One that was deleted has no end to wait for. */
    if (stream->row == before && study_gone(stream))
        stream->done = true;
}

static bool transition_count(const struct study_transition *transition, void *context)
{
    (void)transition;
    (*(int64_t *)context)++;
    return true;
}

int64_t study_stream_backlog(struct study_stream *stream)
{
    struct talus_error error = {0};
    int64_t count = 0;
    if (study_store_transitions(stream->store, stream->id, stream->row, transition_count, &count,
                                &error) != TALUS_OK)
        count = 0;
    return count * event_bytes;
}

static bool transition_skip(const struct study_transition *transition, void *context)
{
    struct study_stream *stream = context;
    bool last = transition->number < 0 && study_state_find(transition->state) != STUDY_RUNNING;
    if (!last)
        stream->row = transition->row;
    return !last;
}

void study_stream_skip(struct study_stream *stream)
{
    struct talus_error error = {0};
    int64_t before = stream->row;
    if (study_store_transitions(stream->store, stream->id, stream->row, transition_skip, stream,
                                &error) != TALUS_OK)
        return;
    stream->looked = false;
    text_print(&stream->out, "id: %" PRId64 "\nevent: gap\ndata: {\"after\":\"%" PRId64 "\"}\n\n",
               stream->row, before);
}

void study_stream_close(struct study_stream *stream)
{
    text_release(&stream->out);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "event_steps.h"

#include <stdlib.h>
#include <string.h>

/* All that decides what a stream tells next, once it has caught up with what it was opened on. */
struct event_place {
    int64_t offset, row, span_row, span_end, final_end;
    struct event_id last, span_next;
    bool done;
};

struct event_step {
    char *folder;
    struct event_place before, after;
    struct text out;
    struct event_step *next;
};

static struct event_place place_of(const struct event_stream *stream)
{
    return (struct event_place){.offset = stream->tail.offset,
                                .row = stream->row,
                                .span_row = stream->span_row,
                                .span_end = stream->span_end,
                                .final_end = stream->final_end,
                                .last = stream->last,
                                .span_next = stream->span_next,
                                .done = stream->done};
}

static bool id_equal(struct event_id one, struct event_id other)
{
    return one.offset == other.offset && one.number == other.number;
}

/* `last` says nothing about what follows. */
static bool place_equal(const struct event_place *one, const struct event_place *other)
{
    return one->offset == other->offset && one->row == other->row &&
           one->span_row == other->span_row && one->span_end == other->span_end &&
           id_equal(one->span_next, other->span_next);
}

/* Whether nothing but its place decides what the stream tells. */
static bool stream_is_live(const struct event_stream *stream)
{
    bool in_span = stream->span_row < stream->span_end;
    return !stream->mute && !stream->done && stream->final_line == NULL &&
           stream->tail.offset >= stream->replay_end &&
           stream->after.offset <= stream->tail.offset &&
           (!in_span || stream->after.offset < stream->span_next.offset);
}

static void step_follow(const struct event_step *step, struct event_stream *stream)
{
    const struct event_place *after = &step->after;
    text_add(&stream->out, step->out.data, step->out.length);
    stream->tail.offset = after->offset;
    stream->row = after->row;
    stream->span_row = after->span_row;
    stream->span_end = after->span_end;
    stream->final_end = after->final_end;
    stream->span_next = after->span_next;
    stream->done = after->done;
    if (step->out.length > 0)
        stream->last = after->last;
    /* The step may have passed a rewind, behind which the history is another file. Who follows
     * needs no file: thousands of readers must not each keep one open. */
    history_reader_close(&stream->history);
    event_tail_close(&stream->tail);
}

static void step_destroy(struct event_step *step)
{
    free(step->folder);
    text_release(&step->out);
    free(step);
}

/* Notes the step that a stream has just made from `before`. */
static void step_note(struct event_steps *steps, const struct event_stream *stream,
                      const struct event_place *before)
{
    struct event_step *step = calloc(1, sizeof *step);
    if (step == NULL)
        return;
    step->folder = strdup(stream->folder);
    step->before = *before;
    step->after = place_of(stream);
    if (stream->out.length > 0)
        text_add(&step->out, stream->out.data, stream->out.length);
    if (step->folder == NULL || step->out.failed) {
        step_destroy(step);
        return;
    }
    step->next = steps->first;
    steps->first = step;
}

void event_steps_fill(struct event_steps *steps, struct event_stream *stream)
{
    const struct event_place before = place_of(stream);
    bool live = stream_is_live(stream) && stream->out.length == 0;
    for (const struct event_step *step = steps->first; live && step != NULL; step = step->next) {
        if (place_equal(&step->before, &before) && strcmp(step->folder, stream->folder) == 0) {
            step_follow(step, stream);
            return;
        }
    }
    (void)event_stream_fill(stream);
    /* A final state that is told without its `done` is the stream's own affair. */
    if (live && !stream->out.failed && (stream->final_line == NULL || stream->done))
        step_note(steps, stream, &before);
}

void event_steps_clear(struct event_steps *steps)
{
    while (steps->first != NULL) {
        struct event_step *next = steps->first->next;
        step_destroy(steps->first);
        steps->first = next;
    }
}

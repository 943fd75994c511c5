/* SPDX-License-Identifier: Apache-2.0 */
#include "event_source.h"

struct text *event_source_out(struct event_source *source)
{
    if (source->kind == SOURCE_ALL)
        return &source->reader.out;
    return source->kind == SOURCE_STUDY ? &source->study.out : &source->stream.out;
}

void event_source_fill(struct event_source *source, struct event_steps *steps)
{
    if (source->kind == SOURCE_ALL)
        feed_reader_fill(&source->reader);
    else if (source->kind == SOURCE_STUDY)
        study_stream_fill(&source->study);
    else if (!source->stream.done)
        event_steps_fill(steps, &source->stream);
}

void event_source_skip(struct event_source *source)
{
    if (source->kind == SOURCE_ALL)
        feed_reader_skip(&source->reader);
    else if (source->kind == SOURCE_STUDY)
        study_stream_skip(&source->study);
    else
        event_stream_skip(&source->stream);
}

int64_t event_source_backlog(struct event_source *source)
{
    if (source->kind == SOURCE_ALL)
        return feed_reader_backlog(&source->reader);
    return source->kind == SOURCE_STUDY ? study_stream_backlog(&source->study)
                                        : event_stream_backlog(&source->stream);
}

bool event_source_done(const struct event_source *source)
{
    return (source->kind == SOURCE_JOB && source->stream.done) ||
           (source->kind == SOURCE_STUDY && source->study.done);
}

void event_source_close(struct event_source *source)
{
    if (source->kind == SOURCE_ALL)
        feed_reader_close(&source->reader);
    else if (source->kind == SOURCE_STUDY)
        study_stream_close(&source->study);
    else
        event_stream_close(&source->stream);
}

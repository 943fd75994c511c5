/* SPDX-License-Identifier: Apache-2.0 */
#include "event_source.h"

struct text *event_source_out(struct event_source *source)
{
    return source->of_all ? &source->reader.out : &source->stream.out;
}

void event_source_fill(struct event_source *source, struct event_steps *steps)
{
    if (source->of_all)
        feed_reader_fill(&source->reader);
    else if (!source->stream.done)
        event_steps_fill(steps, &source->stream);
}

void event_source_skip(struct event_source *source)
{
    if (source->of_all)
        feed_reader_skip(&source->reader);
    else
        event_stream_skip(&source->stream);
}

int64_t event_source_backlog(struct event_source *source)
{
    return source->of_all ? feed_reader_backlog(&source->reader)
                          : event_stream_backlog(&source->stream);
}

bool event_source_done(const struct event_source *source)
{
    return !source->of_all && source->stream.done;
}

void event_source_close(struct event_source *source)
{
    if (source->of_all)
        feed_reader_close(&source->reader);
    else
        event_stream_close(&source->stream);
}

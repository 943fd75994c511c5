/* SPDX-License-Identifier: Apache-2.0 */
/* Server-Sent Events (WHATWG HTML, 9.2) out of a byte stream that comes in arbitrary pieces. */
#ifndef TALUS_EVENT_PARSER_H
#define TALUS_EVENT_PARSER_H

#include <stdbool.h>
#include <stddef.h>

enum { EVENT_LINE_MAX = 8 << 20 }; /* a longer line is not from a talusd */

struct event_buffer {
    char *text; /* NUL-terminated once anything was added */
    size_t length, capacity;
};

/* Zero it before use; release it. */
struct event_parser {
    struct event_buffer line, data;
    char name[64];
    char id[64];         /* of the last complete event: Last-Event-ID of the next connection */
    char id_pending[64]; /* of the event that is being received */
    bool after_return;   /* the last byte was a carriage return */
    /* Called for every event; false ends the stream. */
    bool (*emit)(void *context, const char *name, const char *id, const char *data);
    void *context;
};

/* False when emit() wanted to end, memory ran out or a line is too long. */
bool event_parser_feed(struct event_parser *parser, const char *bytes, size_t length);
/* Forgets a half-received event, before a new connection; the last id stays. */
void event_parser_restart(struct event_parser *parser);
void event_parser_release(struct event_parser *parser);

#endif

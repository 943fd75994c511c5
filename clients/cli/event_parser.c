/* SPDX-License-Identifier: Apache-2.0 */
#include "event_parser.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool buffer_add(struct event_buffer *buffer, const char *bytes, size_t length)
{
    if (length > EVENT_LINE_MAX || buffer->length > EVENT_LINE_MAX - length)
        return false;
    if (buffer->length + length + 1 > buffer->capacity) {
        const size_t capacity = 2 * (buffer->length + length) + 256;
        char *text = realloc(buffer->text, capacity);
        if (text == NULL)
            return false;
        buffer->text = text;
        buffer->capacity = capacity;
    }
    if (length > 0)
        memcpy(buffer->text + buffer->length, bytes, length);
    buffer->length += length;
    buffer->text[buffer->length] = '\0';
    return true;
}

static void buffer_clear(struct event_buffer *buffer)
{
    buffer->length = 0;
    if (buffer->text != NULL)
        buffer->text[0] = '\0';
}

/* An empty line ends an event; one without data is dropped. */
static bool end_event(struct event_parser *parser)
{
    bool go_on = true;
    memcpy(parser->id, parser->id_pending, sizeof parser->id);
    if (parser->data.length > 0) {
        parser->data.text[parser->data.length - 1] = '\0'; /* the last line feed */
        go_on = parser->emit(parser->context, parser->name[0] == '\0' ? "message" : parser->name,
                             parser->id, parser->data.text);
    }
    buffer_clear(&parser->data);
    parser->name[0] = '\0';
    return go_on;
}

static bool end_line(struct event_parser *parser)
{
    const char *line = parser->line.text == NULL ? "" : parser->line.text;
    if (line[0] == '\0')
        return end_event(parser);
    const size_t key_length = strcspn(line, ":");
    const char *value = line + key_length;
    if (*value == ':')
        value++;
    if (*value == ' ')
        value++;
    bool fine = true;
    if (key_length == 4 && strncmp(line, "data", 4) == 0)
        fine =
            buffer_add(&parser->data, value, strlen(value)) && buffer_add(&parser->data, "\n", 1);
    else if (key_length == 5 && strncmp(line, "event", 5) == 0)
        (void)snprintf(parser->name, sizeof parser->name, "%s", value);
    else if (key_length == 2 && strncmp(line, "id", 2) == 0)
        (void)snprintf(parser->id_pending, sizeof parser->id_pending, "%s", value);
    buffer_clear(&parser->line);
    return fine;
}

bool event_parser_feed(struct event_parser *parser, const char *bytes, size_t length)
{
    while (length > 0) {
        if (parser->after_return && *bytes == '\n') { /* the second half of a line's end */
            parser->after_return = false;
            bytes++;
            length--;
            continue;
        }
        size_t piece = 0;
        while (piece < length && bytes[piece] != '\n' && bytes[piece] != '\r')
            piece++;
        if (!buffer_add(&parser->line, bytes, piece))
            return false;
        parser->after_return = piece < length && bytes[piece] == '\r';
        if (piece < length && !end_line(parser))
            return false;
        const size_t used = piece < length ? piece + 1 : piece;
        bytes += used;
        length -= used;
    }
    return true;
}

void event_parser_restart(struct event_parser *parser)
{
    buffer_clear(&parser->line);
    buffer_clear(&parser->data);
    parser->name[0] = '\0';
    memcpy(parser->id_pending, parser->id, sizeof parser->id);
    parser->after_return = false;
}

void event_parser_release(struct event_parser *parser)
{
    free(parser->line.text);
    free(parser->data.text);
    memset(parser, 0, sizeof *parser);
}

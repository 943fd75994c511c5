/* SPDX-License-Identifier: Apache-2.0 */
#include "loadgen_answer.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The value of a header field, or NULL. */
static const char *field_find(const char *head, const char *name)
{
    size_t length = strlen(name);
    for (const char *line = strstr(head, "\r\n"); line != NULL; line = strstr(line + 2, "\r\n")) {
        if (strncasecmp(line + 2, name, length) == 0 && line[2 + length] == ':')
            return line + 2 + length + 1 + strspn(line + 2 + length + 1, " ");
    }
    return NULL;
}

static void head_read(struct answer *answer)
{
    const char *length = field_find(answer->head, "Content-Length");
    const char *encoding = field_find(answer->head, "Transfer-Encoding");
    answer->broken = strncmp(answer->head, "HTTP/1.1 ", 9) != 0;
    answer->status = (int)strtol(answer->head + 9, NULL, 10);
    answer->chunked = encoding != NULL && strncasecmp(encoding, "chunked", 7) == 0;
    answer->left = length == NULL ? 0 : (size_t)strtoull(length, NULL, 10);
    if (answer->chunked)
        answer->part = ANSWER_SIZE;
    else
        answer->part = answer->left > 0 ? ANSWER_BODY : ANSWER_END;
    answer->head_length = 0;
}

/* Collects a line or the head until it ends in `end`, which ends in a newline; the bytes that were
 * used. */
static size_t collect(struct answer *answer, const char *data, size_t length, const char *end,
                      bool *complete)
{
    size_t used = 0, end_length = strlen(end);
    *complete = false;
    while (used < length && !*complete && !answer->broken) {
        const char *newline = memchr(data + used, '\n', length - used);
        size_t more = newline == NULL ? length - used : (size_t)(newline - data) + 1 - used;
        answer->broken = answer->head_length + more >= sizeof answer->head;
        if (answer->broken)
            break;
        memcpy(answer->head + answer->head_length, data + used, more);
        answer->head_length += more;
        answer->head[answer->head_length] = '\0';
        used += more;
        *complete = answer->head_length >= end_length &&
                    memcmp(answer->head + answer->head_length - end_length, end, end_length) == 0;
    }
    return used;
}

static void size_read(struct answer *answer)
{
    char *end = NULL;
    answer->left = (size_t)strtoull(answer->head, &end, 16);
    answer->broken = answer->broken || end == answer->head;
    answer->part = answer->left > 0 ? ANSWER_CHUNK : ANSWER_TAIL;
    answer->head_length = 0;
}

static size_t step(struct answer *answer, const char *data, size_t length,
                   void (*body)(void *context, const char *data, size_t length), void *context)
{
    bool complete;
    size_t used = length < answer->left ? length : answer->left;
    switch (answer->part) {
    case ANSWER_HEAD:
        used = collect(answer, data, length, "\r\n\r\n", &complete);
        if (complete)
            head_read(answer);
        return used;
    case ANSWER_SIZE:
        used = collect(answer, data, length, "\n", &complete);
        if (complete && answer->head_length > 2)
            size_read(answer);
        else if (complete)
            answer->head_length = 0; /* the line that ends the chunk before */
        return used;
    case ANSWER_TAIL:
        used = collect(answer, data, length, "\r\n", &complete);
        if (complete)
            answer->part = ANSWER_END;
        return used;
    default:
        if (body != NULL)
            body(context, data, used);
        answer->left -= used;
        if (answer->left == 0)
            answer->part = answer->part == ANSWER_CHUNK ? ANSWER_SIZE : ANSWER_END;
        return used;
    }
}

size_t answer_take(struct answer *answer, const char *data, size_t length,
                   void (*body)(void *context, const char *data, size_t length), void *context)
{
    size_t used = 0;
    while (used < length && answer->part != ANSWER_END && !answer->broken)
        used += step(answer, data + used, length - used, body, context);
    return used;
}

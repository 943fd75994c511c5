/* SPDX-License-Identifier: Apache-2.0 */
/* Reads one answer of HTTP/1.1 as its bytes arrive, in pieces of any size. */
#ifndef TALUS_LOADGEN_ANSWER_H
#define TALUS_LOADGEN_ANSWER_H

#include <stdbool.h>
#include <stddef.h>

enum { ANSWER_HEAD_BYTES = 2048 };

enum answer_part { ANSWER_HEAD, ANSWER_BODY, ANSWER_SIZE, ANSWER_CHUNK, ANSWER_TAIL, ANSWER_END };

/* Zeroed is the beginning of an answer. */
struct answer {
    enum answer_part part;
    char head[ANSWER_HEAD_BYTES];
    size_t head_length;
    int status;
    size_t left; /* bytes of the body or of the chunk that are still to come */
    bool chunked, broken;
};

/* Takes bytes and returns how many belong to this answer. What is of the body goes to `body` (NULL:
 * is dropped) in order. Afterwards part is ANSWER_END if the answer is complete. */
size_t answer_take(struct answer *answer, const char *data, size_t length,
                   void (*body)(void *context, const char *data, size_t length), void *context);

#endif

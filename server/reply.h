/* SPDX-License-Identifier: Apache-2.0 */
/* The answer to a request: a status and a response of the HTTP library. */
#ifndef TALUS_REPLY_H
#define TALUS_REPLY_H

#include "talus/status.h"
#include "text.h"

#include <jansson.h>
#include <microhttpd.h>
#include <stdbool.h>
#include <stdint.h>

enum { PROBLEM_ERROR_MAX = 50 };

/* Owns `response` (NULL: not answered yet). */
struct reply {
    unsigned int status;
    struct MHD_Response *response;
    bool close;  /* the connection must not be used again */
    bool stream; /* its length is not known */
};

/* Each of these makes the whole reply; out of memory leaves `response` NULL, which the HTTP layer
 * turns into a closed connection. */
void reply_text(struct reply *reply, unsigned int status, const char *type, struct text *text);
/* JSON that is a text already. */
void reply_json_text(struct reply *reply, unsigned int status, struct text *text);
/* JSON with its newline that others use too: `release` is called once when it is not needed any
 * more, also if the reply could not be made. */
void reply_json_shared(struct reply *reply, unsigned int status, char *data, size_t length,
                       void (*release)(void *context), void *context);
/* Takes the reference. */
void reply_json(struct reply *reply, unsigned int status, json_t *value);
/* The same under another media type. */
void reply_document(struct reply *reply, unsigned int status, const char *type, json_t *value);
void reply_empty(struct reply *reply, unsigned int status);
/* Part of a file; takes the descriptor. */
void reply_file(struct reply *reply, unsigned int status, const char *type, int descriptor,
                uint64_t first, uint64_t length);
/* An event stream; takes the response. */
void reply_stream(struct reply *reply, struct MHD_Response *response);
void reply_header(struct reply *reply, const char *name, const char *value);
/* RFC 9457. `code` becomes urn:talus:problem:CODE; `errors` is an array or NULL (the reference is
 * taken; more than 50 are cut); `instance` is the request's target or NULL. */
void reply_problem(struct reply *reply, unsigned int status, const char *code, const char *instance,
                   json_t *errors, const char *format, ...) __attribute__((format(printf, 6, 7)));
/* The same with members of its own (the reference is taken) instead of `errors`. */
void reply_problem_with(struct reply *reply, unsigned int status, const char *code,
                        const char *instance, json_t *members, const char *format, ...)
    __attribute__((format(printf, 6, 7)));
/* What went wrong inside: "not_found" is 404, "state" 409, no answer
 * of a helper 503, ..., anything else 500. */
void reply_error(struct reply *reply, const char *instance, const struct talus_error *error);
void reply_release(struct reply *reply);

/* Adds { pointer, code, detail } and, if not NULL, `given` and `allowed` (borrowed). */
void issue_add(json_t *errors, const char *pointer, const char *code, const json_t *given,
               const json_t *allowed, const char *format, ...)
    __attribute__((format(printf, 6, 7)));

#endif

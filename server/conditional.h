/* SPDX-License-Identifier: Apache-2.0 */
/* Conditional requests (RFC 9110, section 13): strong entity tags of what is read. */
#ifndef TALUS_CONDITIONAL_H
#define TALUS_CONDITIONAL_H

#include "request.h"

enum { CONDITIONAL_ETAG_SIZE = 80 };

extern const char *const conditional_headers[];
/* The answer to a reader that has it already. */
#define CONDITIONAL_UNCHANGED                                                                      \
    {                                                                                              \
        .status = 304, .headers = conditional_headers, .meaning = "unchanged"                      \
    }

extern const unsigned int conditional_problems[]; /* what it can be answered besides */

/* A tag of bytes that decide an answer; "" if it cannot be made. */
void conditional_etag(const char *data, size_t length, char etag[CONDITIONAL_ETAG_SIZE]);
/* Answers 412 or 304 where If-Match or If-None-Match asks for that. False: the answer is due, and
 * conditional_mark belongs behind it. */
bool conditional_reply(struct request *request, const char *etag);
/* Puts the tag into an answer that is made. */
void conditional_mark(struct request *request, const char *etag);
/* A JSON document (the reference is taken) under a media type, with the tag of its text. */
void conditional_document(struct request *request, const char *type, json_t *value);

#endif

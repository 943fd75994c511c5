/* SPDX-License-Identifier: Apache-2.0 */
/* Revisions of jobs and studies over HTTP: ETag, If-Match, If-None-Match, and the wait for another.
 */
#ifndef TALUS_REVISION_H
#define TALUS_REVISION_H

#include "request.h"

enum { REVISION_ETAG_SIZE = 32 };

/* For the tables of operations. Of one that reads: its query, its headers, those of its answer, and
 * the answer to a reader that has it already. */
extern const struct json_field revision_wait_query[], revision_known_headers[];
extern const char *const revision_headers[];
#define REVISION_UNCHANGED                                                                         \
    {                                                                                              \
        .status = 304, .headers = revision_headers, .meaning = "it has the ETag that is known"     \
    }
/* Of one that changes: its headers, and the problems that it can have. */
extern const struct json_field revision_match_headers[];
extern const unsigned int revision_problems[];

void revision_etag(int64_t revision, char etag[REVISION_ETAG_SIZE]);
/* The revision that If-Match asks for, -1 for any, of a thing that is at one. False: it is not at
 * that one, and the reply is made; `what` names the thing. */
bool revision_wanted(struct request *request, const char *what, int64_t revision, int64_t *wanted);
/* Begins the wait that the query asks for, unless it has begun. */
void revision_wait_begin(struct request *request);
/* Whether the answer is due now; else the request is to wait. */
bool revision_due(const struct request *request, int64_t revision, bool final);
/* Whether the client knows the revision; then the reply, 304, is made. */
bool revision_known(struct request *request, int64_t revision);

#endif

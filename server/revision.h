/* SPDX-License-Identifier: Apache-2.0 */
/* Revisions of jobs and studies over HTTP: ETag, If-Match, If-None-Match, and the wait for another.
 */
#ifndef TALUS_REVISION_H
#define TALUS_REVISION_H

#include "request.h"

enum { REVISION_ETAG_SIZE = 32, REVISION_WAIT_SECONDS_MAX = 60 };

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

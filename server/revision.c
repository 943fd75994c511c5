/* SPDX-License-Identifier: Apache-2.0 */
#include "revision.h"

#include "byte_range.h"
#include "moment.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { WAIT_SECONDS_MAX = 60 };

const struct json_field revision_wait_query[] = {
    {.key = "wait",
     .kind = FIELD_NUMBER,
     .optional = true,
     .minimum = 0,
     .maximum = WAIT_SECONDS_MAX,
     .meaning = "seconds to wait at most: with If-None-Match until the revision differs, without "
                "it until the end"},
    OPERATION_END};
const struct json_field revision_known_headers[] = {
    {.key = "If-None-Match", .optional = true, .meaning = "ETag that is known already"},
    OPERATION_END};
const char *const revision_headers[] = {"ETag", NULL};
const struct json_field revision_match_headers[] = {
    {.key = "If-Match", .optional = true, .meaning = "only while this is its ETag, its revision"},
    OPERATION_END};
const unsigned int revision_problems[] = {409, 412, 0};

void revision_etag(int64_t revision, char etag[REVISION_ETAG_SIZE])
{
    (void)snprintf(etag, REVISION_ETAG_SIZE, "\"%" PRId64 "\"", revision);
}

bool revision_wanted(struct request *request, const char *what, int64_t revision, int64_t *wanted)
{
    const char *header = request_header(request, MHD_HTTP_HEADER_IF_MATCH);
    char etag[REVISION_ETAG_SIZE];
    revision_etag(revision, etag);
    bool matches = header == NULL || etag_listed(header, etag, false);
    *wanted = header != NULL && matches && strchr(header, '*') == NULL ? revision : -1;
    if (!matches)
        reply_problem(&request->reply, MHD_HTTP_PRECONDITION_FAILED, "revision", request->raw, NULL,
                      "the %s has changed: it is at revision %" PRId64, what, revision);
    return matches;
}

void revision_wait_begin(struct request *request)
{
    const double wait = request_query_number(request, "wait");
    if (wait > 0 && request->deadline <= 0)
        request->deadline = moment_monotonic() + wait;
}

bool revision_due(const struct request *request, int64_t revision, bool final)
{
    const char *known = request_header(request, MHD_HTTP_HEADER_IF_NONE_MATCH);
    char etag[REVISION_ETAG_SIZE];
    if (request->deadline <= 0 || request->expired)
        return true;
    if (known == NULL)
        return final;
    revision_etag(revision, etag);
    return !etag_listed(known, etag, true);
}

bool revision_known(struct request *request, int64_t revision)
{
    const char *known = request_header(request, MHD_HTTP_HEADER_IF_NONE_MATCH);
    char etag[REVISION_ETAG_SIZE];
    revision_etag(revision, etag);
    if (known == NULL || !etag_listed(known, etag, true))
        return false;
    reply_empty(&request->reply, MHD_HTTP_NOT_MODIFIED);
    reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
    return true;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "conditional.h"

#include "byte_range.h"
#include "checksum.h"
#include "json_text.h"

#include <stdio.h>

const char *const conditional_headers[] = {"ETag", NULL};
const unsigned int conditional_problems[] = {MHD_HTTP_PRECONDITION_FAILED, 0};

void conditional_etag(const char *data, size_t length, char etag[CONDITIONAL_ETAG_SIZE])
{
    struct talus_error error = {0};
    char checksum[CHECKSUM_SIZE];
    etag[0] = '\0';
    if (checksum_memory(data, length, checksum, &error) == TALUS_OK)
        (void)snprintf(etag, CONDITIONAL_ETAG_SIZE, "\"%.40s\"", checksum);
}

bool conditional_reply(struct request *request, const char *etag)
{
    const char *match = request_header(request, MHD_HTTP_HEADER_IF_MATCH);
    const char *none_match = request_header(request, MHD_HTTP_HEADER_IF_NONE_MATCH);
    if (match != NULL && !etag_listed(match, etag, false)) {
        reply_problem(&request->reply, MHD_HTTP_PRECONDITION_FAILED, "changed", request->raw, NULL,
                      "it is another one by now");
        return true;
    }
    if (none_match == NULL || !etag_listed(none_match, etag, true))
        return false;
    reply_empty(&request->reply, MHD_HTTP_NOT_MODIFIED);
    conditional_mark(request, etag);
    return true;
}

void conditional_mark(struct request *request, const char *etag)
{
    if (etag[0] != '\0')
        reply_header(&request->reply, MHD_HTTP_HEADER_ETAG, etag);
}

void conditional_document(struct request *request, const char *type, json_t *value)
{
    struct text text = {0};
    char etag[CONDITIONAL_ETAG_SIZE];
    json_text_add(&text, value, 0);
    text_add_string(&text, "\n");
    json_decref(value);
    conditional_etag(text.failed ? "" : text.data, text.failed ? 0 : text.length, etag);
    if (conditional_reply(request, etag)) {
        text_release(&text);
        return;
    }
    reply_text(&request->reply, MHD_HTTP_OK, type, &text);
    conditional_mark(request, etag);
    reply_header(&request->reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
}

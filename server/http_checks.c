/* SPDX-License-Identifier: Apache-2.0 */
#include "http_checks.h"

#include "access.h"
#include "http_origin.h"
#include "service.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Both fit into what a connection has for them (CONNECTION_MEMORY); beyond that the library
 * refuses, without a problem document. */
enum { TARGET_BYTES_MAX = 4096, FIELDS_BYTES_MAX = 5120 };

/* What a walk over the header fields finds. */
struct fields {
    size_t bytes, host_count, length_count, encoding_count, type_count, authorization_count;
    const char *host, *length, *encoding;
    bool malformed;
};

/* token of RFC 9110, section 5.6.2 */
static bool is_token(const char *text)
{
    if (text[0] == '\0')
        return false;
    for (; *text != '\0'; text++) {
        bool letter = (*text >= 'a' && *text <= 'z') || (*text >= 'A' && *text <= 'Z') ||
                      (*text >= '0' && *text <= '9');
        if (!letter && strchr("!#$%&'*+-.^_`|~", *text) == NULL)
            return false;
    }
    return true;
}

static bool has_control(const char *text)
{
    for (; *text != '\0'; text++) {
        if (((unsigned char)*text < 0x20 && *text != '\t') || *text == 0x7f)
            return true;
    }
    return false;
}

static enum MHD_Result field_visit(void *context, enum MHD_ValueKind kind, const char *name,
                                   const char *value)
{
    struct fields *fields = context;
    (void)kind;
    value = value == NULL ? "" : value;
    fields->bytes += strlen(name) + strlen(value) + 4;
    fields->malformed = fields->malformed || !is_token(name) || has_control(value);
    if (strcasecmp(name, MHD_HTTP_HEADER_HOST) == 0) {
        fields->host = value;
        fields->host_count++;
    } else if (strcasecmp(name, MHD_HTTP_HEADER_CONTENT_LENGTH) == 0) {
        fields->length = value;
        fields->length_count++;
    } else if (strcasecmp(name, MHD_HTTP_HEADER_TRANSFER_ENCODING) == 0) {
        fields->encoding = value;
        fields->encoding_count++;
    } else if (strcasecmp(name, MHD_HTTP_HEADER_CONTENT_TYPE) == 0) {
        fields->type_count++;
    } else if (strcasecmp(name, MHD_HTTP_HEADER_AUTHORIZATION) == 0) {
        fields->authorization_count++;
    }
    return MHD_YES;
}

static void refuse(struct request *request, unsigned int status, const char *code,
                   const char *detail)
{
    reply_problem(&request->reply, status, code, request->raw, NULL, "%s", detail);
    request->reply.close = true;
}

/* Anything that could make a proxy and this server see different requests is refused. */
static bool framing_check(struct request *request, const struct fields *fields)
{
    const char *problem = NULL;
    if (fields->malformed)
        problem = "a header field is malformed";
    else if (fields->length_count > 1)
        problem = "Content-Length is given more than once";
    else if (fields->encoding_count > 1)
        problem = "Transfer-Encoding is given more than once";
    else if (fields->length_count > 0 && fields->encoding_count > 0)
        problem = "Content-Length and Transfer-Encoding exclude each other";
    else if (fields->encoding_count > 0 && strcasecmp(fields->encoding, "chunked") != 0)
        problem = "the only Transfer-Encoding understood is chunked";
    else if (fields->length_count > 0 &&
             (fields->length[0] == '\0' ||
              strspn(fields->length, "0123456789") != strlen(fields->length)))
        problem = "Content-Length is not a number";
    else if (fields->host_count != 1)
        problem = "exactly one Host is needed";
    else if (fields->type_count > 1)
        problem = "Content-Type is given more than once";
    else if (fields->authorization_count > 1)
        problem = "Authorization is given more than once";
    if (problem != NULL)
        refuse(request, MHD_HTTP_BAD_REQUEST, "framing", problem);
    return problem == NULL;
}

static bool type_is_json(const char *type)
{
    static const char json[] = "application/json";
    if (type == NULL || strncasecmp(type, json, sizeof json - 1) != 0)
        return false;
    type += sizeof json - 1;
    type += strspn(type, " \t");
    if (*type == '\0')
        return true;
    if (*type++ != ';')
        return false;
    type += strspn(type, " \t");
    return *type == '\0' || strcasecmp(type, "charset=utf-8") == 0 ||
           strcasecmp(type, "charset=\"utf-8\"") == 0;
}

static void body_check(struct request *request, const struct fields *fields)
{
    double limit = request->service->config->body_bytes;
    double length = fields->length == NULL ? 0 : strtod(fields->length, NULL);
    if (length > limit) {
        reply_problem(&request->reply, MHD_HTTP_CONTENT_TOO_LARGE, "too_large", request->raw, NULL,
                      "a body has at most %.0f bytes", limit);
        request->reply.close = length > 4 * limit;
        return;
    }
    const char *method = request->route->method;
    if (!http_has_body(request) || (strcmp(method, "POST") != 0 && strcmp(method, "PATCH") != 0))
        return;
    if (request_header(request, MHD_HTTP_HEADER_CONTENT_ENCODING) != NULL)
        reply_problem(&request->reply, MHD_HTTP_UNSUPPORTED_MEDIA_TYPE, "content_encoding",
                      request->raw, NULL, "bodies are taken without Content-Encoding only");
    else if (!type_is_json(request_header(request, MHD_HTTP_HEADER_CONTENT_TYPE)))
        reply_problem(&request->reply, MHD_HTTP_UNSUPPORTED_MEDIA_TYPE, "content_type",
                      request->raw, NULL, "bodies must be application/json in UTF-8");
}

bool http_has_body(const struct request *request)
{
    const char *length = request_header(request, MHD_HTTP_HEADER_CONTENT_LENGTH);
    return request_header(request, MHD_HTTP_HEADER_TRANSFER_ENCODING) != NULL ||
           (length != NULL && strtod(length, NULL) > 0);
}

void http_check(struct request *request)
{
    struct fields fields = {0};
    (void)MHD_get_connection_values(request->connection, MHD_HEADER_KIND, field_visit, &fields);
    if (fields.bytes > FIELDS_BYTES_MAX) {
        refuse(request, MHD_HTTP_REQUEST_HEADER_FIELDS_TOO_LARGE, "fields_too_large",
               "the header fields are too large");
        return;
    }
    if (strlen(request->raw) > TARGET_BYTES_MAX) {
        refuse(request, MHD_HTTP_URI_TOO_LONG, "target_too_long", "the target is too long");
        return;
    }
    if (!framing_check(request, &fields) || !origin_check(request, fields.host))
        return;
    const char *problem = target_parse(&request->target, request->raw);
    if (problem != NULL) {
        refuse(request, MHD_HTTP_BAD_REQUEST, "target", problem);
        return;
    }
    if (origin_preflight(request))
        return;
    request_route(request);
    if (access_check(request) && request->reply.response == NULL && request->route != NULL &&
        request_query_check(request))
        body_check(request, &fields);
}

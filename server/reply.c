/* SPDX-License-Identifier: Apache-2.0 */
#include "reply.h"

#include "json_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { GIVEN_BYTES_MAX = 200 };

static void reply_begin(struct reply *reply, unsigned int status, struct MHD_Response *response,
                        const char *type)
{
    reply_release(reply);
    reply->status = status;
    reply->response = response;
    if (type != NULL)
        reply_header(reply, MHD_HTTP_HEADER_CONTENT_TYPE, type);
    reply_header(reply, "X-Content-Type-Options", "nosniff");
}

void reply_header(struct reply *reply, const char *name, const char *value)
{
    if (reply->response != NULL &&
        MHD_add_response_header(reply->response, name, value) != MHD_YES) {
        MHD_destroy_response(reply->response);
        reply->response = NULL;
    }
}

void reply_text(struct reply *reply, unsigned int status, const char *type, struct text *text)
{
    size_t length = text->length;
    char *data = text_take(text);
    struct MHD_Response *response =
        data == NULL ? NULL : MHD_create_response_from_buffer(length, data, MHD_RESPMEM_MUST_FREE);
    if (response == NULL)
        free(data);
    reply_begin(reply, status, response, type);
}

void reply_document(struct reply *reply, unsigned int status, const char *type, json_t *value)
{
    struct text text = {0};
    json_text_add(&text, value, 0);
    text_add_string(&text, "\n");
    json_decref(value);
    reply_text(reply, status, type, &text);
}

void reply_json_shared(struct reply *reply, unsigned int status, char *data, size_t length,
                       void (*release)(void *context), void *context)
{
    struct MHD_Response *response =
        MHD_create_response_from_buffer_with_free_callback_cls(length, data, release, context);
    if (response == NULL)
        release(context);
    reply_begin(reply, status, response, "application/json");
    reply_header(reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
}

void reply_json_text(struct reply *reply, unsigned int status, struct text *text)
{
    text_add_string(text, "\n");
    reply_text(reply, status, "application/json", text);
    reply_header(reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
}

void reply_json(struct reply *reply, unsigned int status, json_t *value)
{
    struct text text = {0};
    json_text_add(&text, value, 0);
    json_decref(value);
    reply_json_text(reply, status, &text);
}

void reply_empty(struct reply *reply, unsigned int status)
{
    reply_begin(reply, status, MHD_create_response_from_buffer(0, NULL, MHD_RESPMEM_PERSISTENT),
                NULL);
}

void reply_file(struct reply *reply, unsigned int status, const char *type, int descriptor,
                uint64_t first, uint64_t length)
{
    struct MHD_Response *response =
        MHD_create_response_from_fd_at_offset64(length, descriptor, first);
    if (response == NULL)
        (void)close(descriptor);
    reply_begin(reply, status, response, type);
}

void reply_stream(struct reply *reply, struct MHD_Response *response)
{
    reply_begin(reply, MHD_HTTP_OK, response, "text/event-stream");
    reply_header(reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
    reply_header(reply, "X-Accel-Buffering", "no");
    reply->stream = true;
}

static const char *problem_title(unsigned int status)
{
    static const struct {
        unsigned int status;
        const char *title;
    } titles[] = {
        {400, "The request is malformed"},
        {401, "A valid token is needed"},
        {403, "The request is not allowed"},
        {404, "There is no such thing"},
        {405, "The method does not apply here"},
        {406, "No acceptable form"},
        {409, "The state does not allow it"},
        {412, "The precondition does not hold"},
        {413, "The body is too large"},
        {414, "The request target is too long"},
        {415, "The body's type is not JSON"},
        {416, "The range cannot be satisfied"},
        {422, "The request does not make sense"},
        {429, "Too many jobs wait"},
        {431, "The header fields are too large"},
        {503, "The service cannot answer now"},
        {507, "The result would not fit on the disk"},
    };
    for (size_t index = 0; index < sizeof titles / sizeof titles[0]; index++) {
        if (titles[index].status == status)
            return titles[index].title;
    }
    return "Internal error";
}

/* A string, whatever bytes a client sent. */
static json_t *text_json(const char *text)
{
    json_t *string = json_string(text == NULL ? "" : text);
    return string == NULL ? json_string("(not UTF-8)") : string;
}

__attribute__((format(printf, 6, 0))) static void
problem_reply(struct reply *reply, unsigned int status, const char *code, const char *instance,
              json_t *members, const char *format, va_list arguments)
{
    char detail[1024], type[64];
    (void)vsnprintf(detail, sizeof detail, format, arguments);
    (void)snprintf(type, sizeof type, "urn:talus:problem:%s", code);
    json_t *document = json_pack("{s:s, s:s, s:i, s:o, s:o}", "type", type, "title",
                                 problem_title(status), "status", (int)status, "detail",
                                 text_json(detail), "instance", text_json(instance));
    (void)json_object_update_missing(document, members);
    json_decref(members);
    reply_document(reply, status, "application/problem+json", document);
    reply_header(reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
    if (status == MHD_HTTP_SERVICE_UNAVAILABLE || status == MHD_HTTP_TOO_MANY_REQUESTS)
        reply_header(reply, MHD_HTTP_HEADER_RETRY_AFTER, "5");
}

void reply_problem(struct reply *reply, unsigned int status, const char *code, const char *instance,
                   json_t *errors, const char *format, ...)
{
    va_list arguments;
    while (json_array_size(errors) > PROBLEM_ERROR_MAX)
        (void)json_array_remove(errors, json_array_size(errors) - 1);
    json_t *members = errors == NULL ? NULL : json_pack("{s:o}", "errors", errors);
    va_start(arguments, format);
    problem_reply(reply, status, code, instance, members, format, arguments);
    va_end(arguments);
}

void reply_problem_with(struct reply *reply, unsigned int status, const char *code,
                        const char *instance, json_t *members, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    problem_reply(reply, status, code, instance, members, format, arguments);
    va_end(arguments);
}

void reply_error(struct reply *reply, const char *instance, const struct talus_error *error)
{
    unsigned int status = MHD_HTTP_INTERNAL_SERVER_ERROR;
    if (strcmp(error->code, "not_found") == 0)
        status = MHD_HTTP_NOT_FOUND;
    else if (strcmp(error->code, "state") == 0)
        status = MHD_HTTP_CONFLICT;
    else if (strcmp(error->code, "labels") == 0)
        status = MHD_HTTP_UNPROCESSABLE_CONTENT;
    else if (strcmp(error->code, "revision") == 0)
        status = MHD_HTTP_PRECONDITION_FAILED;
    else if (strcmp(error->code, "helper") == 0 || strcmp(error->code, "late") == 0 ||
             strcmp(error->code, "busy") == 0)
        status = MHD_HTTP_SERVICE_UNAVAILABLE;
    reply_problem(reply, status, error->code, instance, NULL, "%s", error->text);
}

void reply_release(struct reply *reply)
{
    if (reply->response != NULL)
        MHD_destroy_response(reply->response);
    memset(reply, 0, sizeof *reply);
}

void issue_add(json_t *errors, const char *pointer, const char *code, const json_t *given,
               const json_t *allowed, const char *format, ...)
{
    char detail[512];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(detail, sizeof detail, format, arguments);
    va_end(arguments);
    json_t *issue =
        json_pack("{s:s, s:s, s:s}", "pointer", pointer, "code", code, "detail", detail);
    /* A client knows its own megabytes. */
    if (given != NULL && !json_is_array(given) && !json_is_object(given) &&
        json_string_length(given) <= GIVEN_BYTES_MAX)
        (void)json_object_set(issue, "given", (json_t *)given);
    if (allowed != NULL)
        (void)json_object_set(issue, "allowed", (json_t *)allowed);
    (void)json_array_append_new(errors, issue);
}

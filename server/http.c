/* SPDX-License-Identifier: Apache-2.0 */
#include "http.h"

#include "access.h"
#include "audit.h"
#include "http_checks.h"
#include "http_origin.h"
#include "http_watch.h"
#include "job_cache.h"
#include "moment.h"
#include "request.h"
#include "service.h"
#include "service_metrics.h"
#include "work_lanes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CONNECTION_MEMORY = 8 << 10, IDLE_SECONDS = 120 };

struct http_server {
    struct service *service;
    struct MHD_Daemon *daemon;
    struct http_watch *watch;
    atomic_bool closing;
};

/* The first the library tells of a request: its target as sent. */
static void *on_target(void *context, const char *target, struct MHD_Connection *connection)
{
    struct http_server *server = context;
    struct request *request = calloc(1, sizeof *request);
    if (request == NULL)
        return NULL;
    request->service = server->service;
    request->connection = connection;
    request->raw = strdup(target);
    if (request->raw != NULL)
        return request;
    free(request);
    return NULL;
}

static void on_completed(void *context, struct MHD_Connection *connection, void **connection_state,
                         enum MHD_RequestTerminationCode code)
{
    struct request *request = *connection_state;
    (void)context;
    (void)connection;
    (void)code;
    if (request == NULL)
        return;
    http_watch_idle(request->watch);
    reply_release(&request->reply);
    target_release(&request->target);
    text_release(&request->body);
    free(request->method);
    free(request->raw);
    free(request);
    *connection_state = NULL;
}

static void on_connection(void *context, struct MHD_Connection *connection, void **socket_context,
                          enum MHD_ConnectionNotificationCode code)
{
    struct http_server *server = context;
    if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
        http_watch_closed(*socket_context);
        *socket_context = NULL;
        return;
    }
    const union MHD_ConnectionInfo *information =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    *socket_context =
        information == NULL ? NULL : http_watch_open(server->watch, information->connect_fd);
}

/* Notes what was refused before a handler saw it: because of who asks, or a change that is
 * malformed. */
static void refusal_note(struct request *request)
{
    if (request->audited || !(request->refused || access_is_change(request)))
        return;
    audit_refusal(request->service->audit, request);
    request->audited = true;
}

/* Gives the reply to the library. */
static enum MHD_Result reply_queue(struct request *request)
{
    struct reply *reply = &request->reply;
    if (reply->response == NULL)
        reply_problem(reply, MHD_HTTP_INTERNAL_SERVER_ERROR, "memory", request->raw, NULL,
                      "out of memory");
    if (reply->response == NULL)
        return MHD_NO;
    origin_reply(request);
    /* To HEAD libmicrohttpd 0.9.75 may send the last chunk of a stream that it does not send. */
    if (reply->close || (reply->stream && strcmp(request->method, "HEAD") == 0))
        reply_header(reply, MHD_HTTP_HEADER_CONNECTION, "close");
    if (reply->response == NULL)
        return MHD_NO;
    refusal_note(request);
    metrics_request(request->service->metrics, request);
    return MHD_queue_response(request->connection, reply->status, reply->response);
}

static enum MHD_Result request_begin(struct request *request, const char *method)
{
    const union MHD_ConnectionInfo *information =
        MHD_get_connection_info(request->connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    request->begun = true;
    request->began = moment_monotonic();
    request->watch = information == NULL ? NULL : information->socket_context;
    request->method = strdup(method);
    if (request->method == NULL)
        return MHD_NO;
    http_check(request);
    if (request->refused || request->reply.response != NULL)
        refusal_note(request);
    if (request->reply.response != NULL && request->reply.close)
        return reply_queue(request);
    return MHD_YES;
}

/* Keeps a part of the body, or lets it pass when the answer is known already. */
static enum MHD_Result body_take(struct request *request, const char *data, size_t length)
{
    double limit = request->service->config->body_bytes;
    request->body_length += length;
    if ((double)request->body_length > 4 * limit)
        return MHD_NO;
    if (request->reply.response != NULL)
        return MHD_YES;
    if ((double)request->body_length > limit) {
        text_release(&request->body);
        reply_problem(&request->reply, MHD_HTTP_CONTENT_TOO_LARGE, "too_large", request->raw, NULL,
                      "a body has at most %.0f bytes", limit);
        refusal_note(request); /* if still more comes there is no answer */
    } else {
        text_add(&request->body, data, length);
    }
    return request->body.failed ? MHD_NO : MHD_YES;
}

/* The request is there in full: answer it now or hand it to a lane. */
static enum MHD_Result request_dispatch(struct http_server *server, struct request *request)
{
    http_watch_arrived(request->watch);
    request->handed_in = true;
    if (request->reply.response != NULL || request->route == NULL)
        return reply_queue(request);
    if (atomic_load(&server->closing)) {
        reply_problem(&request->reply, MHD_HTTP_SERVICE_UNAVAILABLE, "draining", request->raw, NULL,
                      "the daemon is stopping");
        request->reply.close = true;
        return reply_queue(request);
    }
    if (request->route->lane == LANE_INLINE) {
        (void)request->route->handle(request);
        return reply_queue(request);
    }
    if (request->route->lane == LANE_KEPT && job_cache_answer(request))
        return reply_queue(request);
    struct MHD_Connection *connection = request->connection;
    MHD_suspend_connection(connection);
    if (!lanes_hand_in(server->service->lanes, request)) {
        reply_problem(&request->reply, MHD_HTTP_SERVICE_UNAVAILABLE, "busy", request->raw, NULL,
                      "too many requests wait");
        MHD_resume_connection(connection);
    }
    return MHD_YES;
}

static enum MHD_Result on_request(void *context, struct MHD_Connection *connection, const char *url,
                                  const char *method, const char *version, const char *data,
                                  size_t *data_size, void **connection_state)
{
    struct request *request = *connection_state;
    (void)connection;
    (void)url;
    (void)version;
    if (request == NULL)
        return MHD_NO;
    if (!request->begun)
        return request_begin(request, method);
    if (*data_size > 0) {
        size_t length = *data_size;
        *data_size = 0;
        return body_take(request, data, length);
    }
    return request->handed_in ? reply_queue(request) : request_dispatch(context, request);
}

/* The library's own decoding is lenient; target_parse does it. */
static size_t on_unescape(void *context, struct MHD_Connection *connection, char *text)
{
    (void)context;
    (void)connection;
    return strlen(text);
}

__attribute__((format(printf, 2, 0))) static void on_log(void *context, const char *format,
                                                         va_list arguments)
{
    (void)context;
    (void)fputs("talusd: http: ", stderr);
    (void)vfprintf(stderr, format, arguments);
}

enum talus_status http_start(struct http_server **result, struct service *service, int listener,
                             struct talus_error *error)
{
    struct http_server *server = calloc(1, sizeof *server);
    *result = server;
    if (server == NULL) {
        (void)close(listener);
        return talus_error_memory(error);
    }
    enum talus_status status =
        http_watch_create(&server->watch, service->config->request_seconds, error);
    if (status == TALUS_OK) {
        server->service = service;
        server->daemon = MHD_start_daemon(
            MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_ERROR_LOG, 0, NULL,
            NULL, on_request, server, MHD_OPTION_EXTERNAL_LOGGER, on_log, NULL,
            MHD_OPTION_LISTEN_SOCKET, listener, MHD_OPTION_STRICT_FOR_CLIENT, 1,
            MHD_OPTION_URI_LOG_CALLBACK, on_target, server, MHD_OPTION_NOTIFY_COMPLETED,
            on_completed, NULL, MHD_OPTION_NOTIFY_CONNECTION, on_connection, server,
            MHD_OPTION_UNESCAPE_CALLBACK, on_unescape, NULL, MHD_OPTION_CONNECTION_MEMORY_LIMIT,
            (size_t)CONNECTION_MEMORY, MHD_OPTION_CONNECTION_LIMIT,
            (unsigned int)service->config->connections, MHD_OPTION_CONNECTION_TIMEOUT,
            (unsigned int)IDLE_SECONDS, MHD_OPTION_END);
        if (server->daemon == NULL)
            status = talus_error_set(error, TALUS_IO, "http", "", "cannot start the HTTP server");
    }
    if (status != TALUS_OK) {
        (void)close(listener);
        http_stop(server);
        *result = NULL;
    }
    return status;
}

void http_close(struct http_server *server)
{
    atomic_store(&server->closing, true);
}

void http_stop(struct http_server *server)
{
    if (server == NULL)
        return;
    if (server->daemon != NULL)
        MHD_stop_daemon(server->daemon);
    http_watch_destroy(server->watch);
    free(server);
}

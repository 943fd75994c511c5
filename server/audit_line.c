/* SPDX-License-Identifier: Apache-2.0 */
#include "audit_line.h"

#include "json_text.h"
#include "moment.h"
#include "service.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>

enum { TARGET_BYTES_MAX = 512, FORWARDED_BYTES_MAX = 256 };

/* A string of at most so many bytes, whatever a client sent. */
static json_t *bounded(const char *text, size_t limit)
{
    json_t *string = json_stringn(text, strnlen(text, limit));
    return string == NULL ? json_string("(not UTF-8)") : string;
}

static void peer_add(json_t *line, const struct request *request)
{
    char host[INET6_ADDRSTRLEN] = "unix";
    const union MHD_ConnectionInfo *information =
        MHD_get_connection_info(request->connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    const struct sockaddr *address = information == NULL ? NULL : information->client_addr;
    if (address != NULL && address->sa_family == AF_INET)
        (void)inet_ntop(AF_INET, &((const struct sockaddr_in *)address)->sin_addr, host,
                        sizeof host);
    else if (address != NULL && address->sa_family == AF_INET6)
        (void)inet_ntop(AF_INET6, &((const struct sockaddr_in6 *)address)->sin6_addr, host,
                        sizeof host);
    (void)json_object_set_new(line, "from", json_string(host));
    struct ucred peer;
    socklen_t size = sizeof peer;
    information = MHD_get_connection_info(request->connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    if (strcmp(host, "unix") == 0 && information != NULL &&
        getsockopt(information->connect_fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0)
        (void)json_object_set_new(line, "uid", json_integer(peer.uid));
    const char *forwarded = request_header(request, "X-Forwarded-For");
    if (forwarded != NULL)
        (void)json_object_set_new(line, "forwarded_for", bounded(forwarded, FORWARDED_BYTES_MAX));
}

/* The job or study that the path names, or that the request made. */
static void thing_add(json_t *line, const struct request *request)
{
    const struct target *target = &request->target;
    const char *id = request->segment;
    const char *location = request->reply.response == NULL
                               ? NULL
                               : MHD_get_response_header(request->reply.response, "Location");
    const char *slash = location == NULL ? NULL : strrchr(location, '/');
    if (slash != NULL)
        id = slash + 1;
    if (id == NULL || target->segment_count < 2)
        return;
    const char *kind = strcmp(target->segments[1], "jobs") == 0      ? "job"
                       : strcmp(target->segments[1], "studies") == 0 ? "study"
                                                                     : "id";
    (void)json_object_set_new(line, kind, bounded(id, TARGET_BYTES_MAX));
}

void audit_line_request(struct text *line, const struct request *request, uint64_t suppressed)
{
    static const char *const roles[] = {"none", "read", "submit", "admin"};
    char at[MOMENT_TEXT_SIZE];
    const struct principal *principal = &request->principal;
    const char *who = principal->name[0] != '\0'       ? principal->name
                      : principal->role == ROLE_ANYONE ? ""
                                                       : "local";
    moment_now_text(at);
    json_t *object =
        json_pack("{s:s, s:s, s:s}", "at", at, "who", who, "role", roles[principal->role]);
    peer_add(object, request);
    (void)json_object_set_new(object, "method", bounded(request->method, TARGET_BYTES_MAX));
    size_t path = strcspn(request->raw, "?");
    (void)json_object_set_new(
        object, "target", bounded(request->raw, path < TARGET_BYTES_MAX ? path : TARGET_BYTES_MAX));
    (void)json_object_set_new(object, "status", json_integer(request->reply.status));
    thing_add(object, request);
    if (suppressed > 0)
        (void)json_object_set_new(object, "suppressed", json_integer((json_int_t)suppressed));
    json_text_add(line, object, 0);
    text_add_string(line, "\n");
    json_decref(object);
}

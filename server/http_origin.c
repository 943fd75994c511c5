/* SPDX-License-Identifier: Apache-2.0 */
#include "http_origin.h"

#include "access.h"
#include "service.h"

#include <arpa/inet.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { HOST_BYTES_MAX = 260 };
static const char lower_host_characters[] = "abcdefghijklmnopqrstuvwxyz0123456789.-_";
/* What pages may send beyond what browsers allow by themselves, and see of an answer. */
static const char request_fields[] = "Authorization, Content-Type, Idempotency-Key, If-Match, "
                                     "If-None-Match, If-Range, Last-Event-ID, Range";
static const char answer_fields[] = "Content-Disposition, Content-Range, ETag, "
                                    "Idempotent-Replayed, Location, Retry-After, WWW-Authenticate";
static const char preflight_seconds[] = "600";

/* An IPv6 address in brackets. */
static bool six_parse(const char *text, struct in6_addr *six)
{
    char inner[INET6_ADDRSTRLEN];
    size_t length = strlen(text);
    if (length < 2 || length - 2 >= sizeof inner || text[0] != '[' || text[length - 1] != ']')
        return false;
    (void)snprintf(inner, sizeof inner, "%.*s", (int)length - 2, text + 1);
    return inet_pton(AF_INET6, inner, six) == 1;
}

/* A name or an address, IPv6 in brackets, without a port. */
static bool is_host(const char *text)
{
    struct in6_addr six;
    size_t length = strlen(text);
    return six_parse(text, &six) || (length > 0 && strspn(text, lower_host_characters) == length);
}

/* A copy in small letters; false if it is too long. */
static bool host_lower(const char *host, char name[HOST_BYTES_MAX])
{
    size_t length = strlen(host);
    if (length >= HOST_BYTES_MAX)
        return false;
    for (size_t index = 0; index <= length; index++)
        name[index] = (char)tolower((unsigned char)host[index]);
    return true;
}

/* Cuts the port off; false if it is none. */
static bool port_cut(char *host)
{
    char *colon = host[0] == '[' ? strstr(host, "]:") : strchr(host, ':');
    if (colon == NULL)
        return true;
    colon += host[0] == '[';
    if (strspn(colon + 1, "0123456789") != strlen(colon + 1) || strlen(colon + 1) > 5 ||
        strtol(colon + 1, NULL, 10) > 65535)
        return false;
    *colon = '\0';
    return true;
}

/* "https://page.example" or with a port, as a browser writes it in Origin. */
static bool is_origin(const char *text)
{
    char host[HOST_BYTES_MAX];
    const char *rest = strstr(text, "://");
    if (rest == NULL || strlen(rest + 3) >= sizeof host ||
        (strncmp(text, "http://", 7) != 0 && strncmp(text, "https://", 8) != 0))
        return false;
    (void)snprintf(host, sizeof host, "%s", rest + 3);
    return host[strlen(host) - (host[0] != '\0')] != ':' && port_cut(host) && is_host(host);
}

enum talus_status origin_config_check(const struct config *config, struct talus_error *error)
{
    for (char **host = config->hosts; host != NULL && *host != NULL; host++) {
        if (!is_host(*host))
            return talus_error_set(error, TALUS_INVALID, "hosts", "",
                                   "hosts: \"%s\" is not a name in small letters or an address "
                                   "without a port",
                                   *host);
    }
    for (char **origin = config->cors_origins; origin != NULL && *origin != NULL; origin++) {
        if (!is_origin(*origin))
            return talus_error_set(error, TALUS_INVALID, "cors_origins", "",
                                   "cors_origins: \"%s\" is not an origin such as "
                                   "https://page.example:8443, in small letters, with no path",
                                   *origin);
    }
    return TALUS_OK;
}

static bool is_loopback(const char *name)
{
    struct in_addr four;
    struct in6_addr six;
    return strcmp(name, "localhost") == 0 ||
           (six_parse(name, &six) && IN6_IS_ADDR_LOOPBACK(&six)) ||
           (inet_pton(AF_INET, name, &four) == 1 && (ntohl(four.s_addr) >> 24) == 127);
}

static bool is_listed(const char *name, char *const *list)
{
    for (; list != NULL && *list != NULL; list++) {
        if (strcmp(name, *list) == 0)
            return true;
    }
    return false;
}

/* The origin of the page that calls, if it is on the list. */
static const char *listed_origin(const struct request *request)
{
    char *const *list = request->service->config->cors_origins;
    const char *origin = request_header(request, MHD_HTTP_HEADER_ORIGIN);
    for (; origin != NULL && list != NULL && *list != NULL; list++) {
        if (strcmp(origin, *list) == 0)
            return origin;
    }
    return NULL;
}

static bool refuse(struct request *request, const char *code, const char *detail)
{
    reply_problem(&request->reply, MHD_HTTP_FORBIDDEN, code, request->raw, NULL, "%s", detail);
    request->reply.close = true;
    request->refused = true;
    return false;
}

/* Where no token is asked for, only names of this machine, and those a proxy is known to send: a
 * page whose name was made to point here (DNS rebinding) carries its own. Elsewhere the token
 * protects, and `hosts` restricts if it is given. */
bool origin_check(struct request *request, const char *host)
{
    const struct config *config = request->service->config;
    char name[HOST_BYTES_MAX];
    bool good = host_lower(host, name) && port_cut(name);
    bool loopback = good && is_loopback(name);
    bool listed = good && is_listed(name, config->hosts);
    bool any = good && is_host(name) && config->hosts == NULL &&
               !access_is_local(request->service->access);
    if (!loopback && !listed && !any)
        return refuse(request, "host", "Host does not name this machine");
    const char *origin = request_header(request, MHD_HTTP_HEADER_ORIGIN);
    if (origin == NULL || listed_origin(request) != NULL)
        return true;
    /* A proxy that speaks TLS serves pages of its own name. */
    const char *authority = strncmp(origin, "http://", 7) == 0                       ? origin + 7
                            : strncmp(origin, "https://", 8) == 0 && (listed || any) ? origin + 8
                                                                                     : "";
    return strcasecmp(authority, host) == 0 ||
           refuse(request, "origin", "pages of another origin may not call here");
}

bool origin_preflight(struct request *request)
{
    char methods[REQUEST_METHODS_SIZE];
    if (strcmp(request->method, MHD_HTTP_METHOD_OPTIONS) != 0 || listed_origin(request) == NULL ||
        request_header(request, "Access-Control-Request-Method") == NULL)
        return false;
    request_methods(request, methods);
    if (methods[0] == '\0')
        return false;
    reply_empty(&request->reply, MHD_HTTP_NO_CONTENT);
    reply_header(&request->reply, "Access-Control-Allow-Methods", methods);
    reply_header(&request->reply, "Access-Control-Allow-Headers", request_fields);
    reply_header(&request->reply, "Access-Control-Max-Age", preflight_seconds);
    return true;
}

void origin_reply(struct request *request)
{
    const char *origin = listed_origin(request);
    if (request->service->config->cors_origins == NULL)
        return;
    reply_header(&request->reply, MHD_HTTP_HEADER_VARY, MHD_HTTP_HEADER_ORIGIN);
    if (origin == NULL)
        return;
    reply_header(&request->reply, "Access-Control-Allow-Origin", origin);
    reply_header(&request->reply, "Access-Control-Expose-Headers", answer_fields);
}

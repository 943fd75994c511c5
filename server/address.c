/* SPDX-License-Identifier: Apache-2.0 */
#include "address.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

enum { BACKLOG = 1024, BIND_TRIALS = 40, BIND_PAUSE_MICROSECONDS = 50000 };

union address {
    struct sockaddr any;
    struct sockaddr_in four;
    struct sockaddr_in6 six;
    struct sockaddr_un local;
};

static enum talus_status listen_error(struct talus_error *error, const char *text)
{
    return talus_error_set(error, TALUS_IO, "listen", "", "cannot listen on %s: %s", text,
                           strerror(errno));
}

static enum talus_status socket_open(const union address *address, socklen_t length,
                                     const char *text, int *descriptor, struct talus_error *error)
{
    const int one = 1;
    *descriptor = socket(address->any.sa_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (*descriptor < 0)
        return listen_error(error, text);
    if (address->any.sa_family != AF_UNIX)
        (void)setsockopt(*descriptor, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one);
    /* A child of a daemon that was just killed may hold its socket until it has become a worker. */
    int bound = -1;
    for (int trial = 0; trial < BIND_TRIALS && bound != 0; trial++) {
        if (trial > 0)
            (void)usleep(BIND_PAUSE_MICROSECONDS);
        bound = bind(*descriptor, &address->any, length);
        if (bound != 0 && errno != EADDRINUSE)
            break;
    }
    if (bound == 0 && listen(*descriptor, BACKLOG) == 0)
        return TALUS_OK;
    enum talus_status status = listen_error(error, text);
    (void)close(*descriptor);
    *descriptor = -1;
    return status;
}

/* Removes the socket of a daemon that is gone: nobody answers on it. */
static void socket_clear(const union address *address, socklen_t length)
{
    struct stat information;
    int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (probe >= 0 && stat(address->local.sun_path, &information) == 0 &&
        S_ISSOCK(information.st_mode) && connect(probe, &address->any, length) != 0 &&
        errno == ECONNREFUSED)
        (void)unlink(address->local.sun_path);
    if (probe >= 0)
        (void)close(probe);
}

static enum talus_status unix_listen(const char *path, int *descriptor,
                                     char text[ADDRESS_TEXT_SIZE], struct talus_error *error)
{
    union address address = {.local = {.sun_family = AF_UNIX}};
    if (path[0] == '\0' || strlen(path) >= sizeof address.local.sun_path)
        return talus_error_set(error, TALUS_INVALID, "listen", "",
                               "the path of a Unix socket has 1 to %zu bytes",
                               sizeof address.local.sun_path - 1);
    (void)snprintf(address.local.sun_path, sizeof address.local.sun_path, "%s", path);
    (void)snprintf(text, ADDRESS_TEXT_SIZE, "unix:%s", path);
    socket_clear(&address, sizeof address.local);
    enum talus_status status = socket_open(&address, sizeof address.local, text, descriptor, error);
    if (status == TALUS_OK && chmod(path, 0660) != 0)
        status = listen_error(error, text);
    return status;
}

/* "127.0.0.1:80", "[::1]:80", "localhost:80" */
static bool internet_parse(const char *text, union address *address, socklen_t *length)
{
    char host[64];
    const char *colon = strrchr(text, ':');
    if (colon == NULL || (size_t)(colon - text) >= sizeof host)
        return false;
    (void)snprintf(host, sizeof host, "%.*s", (int)(colon - text), text);
    char *end = NULL;
    long port = strtol(colon + 1, &end, 10);
    if (colon[1] < '0' || colon[1] > '9' || *end != '\0' || port > 65535)
        return false;
    memset(address, 0, sizeof *address);
    size_t size = strlen(host);
    if (size > 2 && host[0] == '[' && host[size - 1] == ']') {
        host[size - 1] = '\0';
        address->six.sin6_family = AF_INET6;
        address->six.sin6_port = htons((uint16_t)port);
        *length = sizeof address->six;
        return inet_pton(AF_INET6, host + 1, &address->six.sin6_addr) == 1;
    }
    address->four.sin_family = AF_INET;
    address->four.sin_port = htons((uint16_t)port);
    *length = sizeof address->four;
    return inet_pton(AF_INET, strcmp(host, "localhost") == 0 ? "127.0.0.1" : host,
                     &address->four.sin_addr) == 1;
}

bool address_is_local(int descriptor)
{
    union address own;
    socklen_t length = sizeof own;
    memset(&own, 0, sizeof own);
    if (getsockname(descriptor, &own.any, &length) != 0)
        return false;
    if (own.any.sa_family == AF_UNIX)
        return true;
    if (own.any.sa_family == AF_INET6)
        return IN6_IS_ADDR_LOOPBACK(&own.six.sin6_addr);
    return own.any.sa_family == AF_INET && (ntohl(own.four.sin_addr.s_addr) >> 24) == 127;
}

static void address_print(const union address *address, char text[ADDRESS_TEXT_SIZE])
{
    char host[INET6_ADDRSTRLEN] = "";
    if (address->any.sa_family == AF_INET6) {
        (void)inet_ntop(AF_INET6, &address->six.sin6_addr, host, sizeof host);
        (void)snprintf(text, ADDRESS_TEXT_SIZE, "http://[%s]:%u", host,
                       (unsigned int)ntohs(address->six.sin6_port));
    } else {
        (void)inet_ntop(AF_INET, &address->four.sin_addr, host, sizeof host);
        (void)snprintf(text, ADDRESS_TEXT_SIZE, "http://%s:%u", host,
                       (unsigned int)ntohs(address->four.sin_port));
    }
}

enum talus_status address_listen(const char *listen_text, int *descriptor,
                                 char text[ADDRESS_TEXT_SIZE], struct talus_error *error)
{
    union address address;
    socklen_t length = 0;
    if (strncmp(listen_text, "unix:", 5) == 0)
        return unix_listen(listen_text + 5, descriptor, text, error);
    if (!internet_parse(listen_text, &address, &length))
        return talus_error_set(error, TALUS_INVALID, "listen", "",
                               "%s is neither ADDR:PORT with a numeric address nor unix:PATH",
                               listen_text);
    enum talus_status status = socket_open(&address, length, listen_text, descriptor, error);
    if (status == TALUS_OK && getsockname(*descriptor, &address.any, &length) != 0)
        status = listen_error(error, listen_text);
    if (status == TALUS_OK)
        address_print(&address, text);
    return status;
}

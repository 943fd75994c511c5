/* SPDX-License-Identifier: Apache-2.0 */
#include "connection.h"

#include "problem_text.h"
#include "subcommand.h"
#include "talus/version.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { CONNECT_SECONDS = 10, ANSWER_SECONDS = 120, SILENCE_SECONDS = 45 };
static const char default_server[] = "http://127.0.0.1:8465";

static bool starts_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

int connection_open(struct connection *connection, const char *server, const char *token)
{
    *connection = (struct connection){0};
    if (server == NULL)
        server = getenv("TALUS_SERVER");
    if (server == NULL || server[0] == '\0')
        server = default_server;
    const bool local = starts_with(server, "unix:");
    if (!local && !starts_with(server, "http://") && !starts_with(server, "https://")) {
        (void)fprintf(stderr, "talus: '%s' is neither http://HOST:PORT nor unix:PATH\n", server);
        return EXIT_USAGE;
    }
    connection->server = strdup(server);
    connection->base = strdup(local ? "http://localhost" : server);
    connection->socket_path = local ? strdup(server + strlen("unix:")) : NULL;
    const bool with_token = token != NULL && token[0] != '\0';
    connection->token = with_token ? strdup(token) : NULL;
    connection->curl = curl_easy_init();
    if (connection->server == NULL || connection->base == NULL ||
        (local && connection->socket_path == NULL) || (with_token && connection->token == NULL) ||
        connection->curl == NULL) {
        (void)fprintf(stderr, "talus: out of memory\n");
        return EXIT_USAGE;
    }
    for (size_t end = strlen(connection->base); end > 0 && connection->base[end - 1] == '/'; end--)
        connection->base[end - 1] = '\0';
    return EXIT_DONE;
}

void connection_close(struct connection *connection)
{
    if (connection->curl != NULL)
        curl_easy_cleanup(connection->curl);
    free(connection->server);
    free(connection->base);
    free(connection->socket_path);
    free(connection->token);
    memset(connection, 0, sizeof *connection);
}

/* What the callbacks of one transfer share. */
struct transfer {
    const struct http_request *request;
    struct http_reply *reply;
    CURL *curl;
    bool stopped; /* by the receiver */
};

static size_t receive_body(char *data, size_t size, size_t count, void *context)
{
    struct transfer *transfer = context;
    struct http_reply *reply = transfer->reply;
    const size_t length = size * count;
    (void)curl_easy_getinfo(transfer->curl, CURLINFO_RESPONSE_CODE, &reply->status);
    if (transfer->request->receive != NULL && reply->status / 100 == 2) {
        transfer->stopped = !transfer->request->receive(transfer->request->context, data, length);
        return transfer->stopped ? 0 : length;
    }
    char *body = realloc(reply->body, reply->length + length + 1);
    if (body == NULL)
        return 0;
    memcpy(body + reply->length, data, length);
    reply->body = body;
    reply->length += length;
    body[reply->length] = '\0';
    return length;
}

static size_t receive_header(char *data, size_t size, size_t count, void *context)
{
    struct transfer *transfer = context;
    char line[256];
    const size_t length = size * count;
    (void)snprintf(line, sizeof line, "%.*s", (int)(length < 255 ? length : 255), data);
    if (strncasecmp(line, "Idempotent-Replayed: true", 25) == 0)
        transfer->reply->replayed = true;
    if (strncasecmp(line, "Retry-After:", 12) == 0)
        transfer->reply->retry_after = strtod(line + 12, NULL);
    return length;
}

/* Appends; NULL when memory ran out (the list is then freed). */
static struct curl_slist *add_header(struct curl_slist *list, const char *header)
{
    struct curl_slist *longer = curl_slist_append(list, header);
    if (longer == NULL)
        curl_slist_free_all(list);
    return longer;
}

static struct curl_slist *make_headers(const struct connection *connection,
                                       const struct http_request *request)
{
    char line[1024];
    struct curl_slist *list = add_header(NULL, "Expect:"); /* no wait for 100 Continue */
    if (list != NULL && request->body != NULL)
        list = add_header(list, "Content-Type: application/json");
    if (list != NULL && connection->token != NULL) {
        (void)snprintf(line, sizeof line, "Authorization: Bearer %s", connection->token);
        list = add_header(list, line);
    }
    for (size_t index = 0; list != NULL && index < 4 && request->headers[index] != NULL; index++)
        list = add_header(list, request->headers[index]);
    return list;
}

/* A proxy from the environment is not meant for this machine. */
static bool is_loopback(const char *base)
{
    return starts_with(base, "http://127.") || starts_with(base, "http://localhost") ||
           starts_with(base, "http://[::1]");
}

static void set_options(const struct connection *connection, const struct http_request *request,
                        struct transfer *transfer, const char *url, struct curl_slist *headers)
{
    CURL *curl = connection->curl;
    (void)curl_easy_setopt(curl, CURLOPT_URL, url);
    (void)curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
    (void)curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, request->method);
    (void)curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
    (void)curl_easy_setopt(curl, CURLOPT_USERAGENT, "talus/" TALUS_VERSION);
    (void)curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
    (void)curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, (long)CONNECT_SECONDS);
    (void)curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, receive_body);
    (void)curl_easy_setopt(curl, CURLOPT_WRITEDATA, transfer);
    (void)curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, receive_header);
    (void)curl_easy_setopt(curl, CURLOPT_HEADERDATA, transfer);
    if (connection->socket_path != NULL)
        (void)curl_easy_setopt(curl, CURLOPT_UNIX_SOCKET_PATH, connection->socket_path);
    if (connection->socket_path != NULL || is_loopback(connection->base))
        (void)curl_easy_setopt(curl, CURLOPT_PROXY, "");
    if (request->body != NULL)
        (void)curl_easy_setopt(curl, CURLOPT_POSTFIELDS, request->body);
    if (request->endless) {
        (void)curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, 1L);
        (void)curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, (long)SILENCE_SECONDS);
    } else {
        (void)curl_easy_setopt(curl, CURLOPT_TIMEOUT, (long)ANSWER_SECONDS);
    }
}

bool connection_send(struct connection *connection, const struct http_request *request,
                     struct http_reply *reply, char *problem, size_t problem_size)
{
    char url[4096];
    struct transfer transfer = {.request = request, .reply = reply, .curl = connection->curl};
    *reply = (struct http_reply){0};
    if (snprintf(url, sizeof url, "%s%s", connection->base, request->path) >= (int)sizeof url) {
        (void)snprintf(problem, problem_size, "the address is too long");
        return false;
    }
    struct curl_slist *headers = make_headers(connection, request);
    if (headers == NULL) {
        (void)snprintf(problem, problem_size, "out of memory");
        return false;
    }
    curl_easy_reset(connection->curl);
    set_options(connection, request, &transfer, url, headers);
    const CURLcode code = curl_easy_perform(connection->curl);
    (void)curl_easy_getinfo(connection->curl, CURLINFO_RESPONSE_CODE, &reply->status);
    curl_slist_free_all(headers);
    reply->complete = code == CURLE_OK;
    if (code == CURLE_OK || (code == CURLE_WRITE_ERROR && transfer.stopped))
        return true;
    (void)snprintf(problem, problem_size, "no answer from %s: %s",
                   connection->socket_path == NULL ? connection->base : connection->socket_path,
                   curl_easy_strerror(code));
    return false;
}

void http_reply_release(struct http_reply *reply)
{
    free(reply->body);
    memset(reply, 0, sizeof *reply);
}

int connection_ask(struct connection *connection, const struct http_request *request,
                   json_t **document)
{
    struct http_reply reply;
    char problem[512];
    int code = EXIT_DONE;
    if (document != NULL)
        *document = NULL;
    if (!connection_send(connection, request, &reply, problem, sizeof problem)) {
        (void)fprintf(stderr, "talus: %s\n", problem);
        code = EXIT_NO_SERVER;
    } else if (reply.status / 100 != 2) {
        problem_print(stderr, reply.status, reply.body, reply.length);
        code = EXIT_REFUSED;
    } else if (document != NULL && reply.body != NULL) {
        json_error_t mistake;
        *document = json_loadb(reply.body, reply.length, 0, &mistake);
        if (*document == NULL) {
            (void)fprintf(stderr, "talus: the answer is not JSON: %s\n", mistake.text);
            code = EXIT_REFUSED;
        }
    }
    http_reply_release(&reply);
    return code;
}

/* Escapes everything but what a path segment may hold; `keep_slashes` for names of files. */
static size_t escape(const char *text, bool keep_slashes, char *out)
{
    size_t length = 0;
    for (; *text != '\0'; text++) {
        const unsigned char letter = (unsigned char)*text;
        const bool plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                           (letter >= '0' && letter <= '9') || strchr("-._~", letter) != NULL ||
                           (keep_slashes && letter == '/');
        if (plain)
            out[length++] = (char)letter;
        else
            length += (size_t)snprintf(out + length, 4, "%%%02X", letter);
    }
    out[length] = '\0';
    return length;
}

char *job_path(const char *id, const char *suffix, const char *name)
{
    return resource_path("jobs", id, suffix, name);
}

char *resource_path(const char *collection, const char *id, const char *suffix, const char *name)
{
    const size_t size = 32 + strlen(collection) + 3 * strlen(id) + strlen(suffix) +
                        (name == NULL ? 0 : 3 * strlen(name));
    char *path = malloc(size);
    if (path == NULL) {
        (void)fprintf(stderr, "talus: out of memory\n");
        return NULL;
    }
    size_t length = (size_t)snprintf(path, size, "/v1/%s/", collection);
    length += escape(id, false, path + length);
    length += (size_t)snprintf(path + length, size - length, "%s", suffix);
    if (name != NULL)
        (void)escape(name, true, path + length);
    return path;
}

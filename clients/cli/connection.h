/* SPDX-License-Identifier: Apache-2.0 */
/* HTTP requests to one talusd, over TCP or a Unix socket. */
#ifndef TALUS_CONNECTION_H
#define TALUS_CONNECTION_H

#include <curl/curl.h>
#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

struct connection {
    CURL *curl;
    char *server;      /* as it was given to connection_open */
    char *base;        /* "http://127.0.0.1:8465" */
    char *socket_path; /* of unix:PATH; else NULL */
    char *token;       /* for Authorization: Bearer; NULL: none */
    bool json;         /* --json */
};

struct http_request {
    const char *method;     /* "GET" */
    const char *path;       /* "/v1/jobs", escaped */
    const char *body;       /* JSON, or NULL */
    const char *headers[4]; /* "Name: value", NULL behind the last */
    /* Gets the body of a 2xx answer piece by piece, instead of `body` of the reply; false ends the
     * transfer. */
    bool (*receive)(void *context, const char *data, size_t length);
    void *context;
    bool endless; /* no limit on the time; ends when nothing came for 45 s */
};

struct http_reply {
    long status;
    bool complete;      /* the server closed the answer properly */
    bool replayed;      /* Idempotent-Replayed */
    double retry_after; /* [s], 0: not said */
    char *body;         /* NUL-terminated; NULL if there was none */
    size_t length;
};

/* `server` as in --server; NULL: $TALUS_SERVER, else http://127.0.0.1:8465. The token is the first
 * line of `token_file`; NULL: $TALUS_TOKEN. Prints and returns an exit code on failure; close in
 * any case. */
int connection_open(struct connection *connection, const char *server, const char *token);
void connection_close(struct connection *connection);

/* Returns true if an answer came (of any status); false, with a text in `problem`, if none did or
 * the transfer broke (status then says whether it had begun). Release the reply in any case. */
bool connection_send(struct connection *connection, const struct http_request *request,
                     struct http_reply *reply, char *problem, size_t problem_size);
void http_reply_release(struct http_reply *reply);

/* Sends and reads a JSON answer: EXIT_DONE with a new reference in *document (NULL where the answer
 * is empty), else the reason is printed and the exit code returned. document may be NULL. */
int connection_ask(struct connection *connection, const struct http_request *request,
                   json_t **document);

/* "/v1/jobs/ID" + suffix, with the ID and `name` (may be NULL; its slashes stay) escaped; free it.
 * NULL, with a message, when memory ran out. */
char *job_path(const char *id, const char *suffix, const char *name);
/* The same under another collection than "jobs": "studies". */
char *resource_path(const char *collection, const char *id, const char *suffix, const char *name);

#endif

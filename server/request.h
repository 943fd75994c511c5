/* SPDX-License-Identifier: Apache-2.0 */
/* One request, from its first byte to its answer, and the table of routes. */
#ifndef TALUS_REQUEST_H
#define TALUS_REQUEST_H

#include "job.h"
#include "operation.h"
#include "reply.h"
#include "request_principal.h"
#include "target.h"
#include "text.h"

#include <microhttpd.h>
#include <stdbool.h>
#include <stdint.h>

struct service;
struct helper;
struct event_stream;
struct connection_watch;

enum lane { LANE_INLINE, LANE_KEPT, LANE_QUICK, LANE_HELPER };
enum handled {
    HANDLED,        /* request->reply is made */
    HANDLED_PARKED, /* a wait holds the request and will hand it in again */
};

enum { REQUEST_METHODS_SIZE = 64 };

struct request;

struct route {
    const char *method, *path;
    const char *name; /* of the handler */
    enum lane lane;
    enum role role; /* the least that a caller needs */
    enum handled (*handle)(struct request *request);
    const struct operation *operation;
};

/* Owned by the HTTP library's connection; while it is suspended, by the lane or wait that has it.
 */
struct request {
    struct service *service;
    struct MHD_Connection *connection;
    struct connection_watch *watch;
    char *raw;    /* the target as sent */
    char *method; /* "HEAD" has the route of "GET" */
    struct target target;
    struct principal principal;
    struct token_proof proof;
    const struct route *route;
    const char *segment; /* what the first "*" stands for */
    char rest[1024];     /* what the second "*" or "**" stands for */
    struct text body;
    uint64_t body_length; /* received, kept or not */
    struct reply reply;
    struct helper *helper; /* HELPER lane: the process to ask */
    double began;          /* its header fields were there (monotonic [s]) */
    bool begun;            /* headers are checked */
    bool refused;          /* because of who asks */
    bool audited;          /* is in the audit log */
    bool handed_in;        /* was given to a lane */
    double deadline;       /* of a wait (monotonic), 0: not waiting yet */
    bool expired;          /* the wait is over, answer */
    int64_t revision;      /* waits end when the job's revision is another; -1: only at the end */
    struct request *next;
};

#define ROUTE(method, path, lane, role, handler)                                                   \
    enum handled handle_##handler(struct request *request);                                        \
    extern const struct operation operation_##handler;
#include "routes.def"
#undef ROUTE

extern const struct route request_routes[];
extern const size_t request_route_count;

/* Finds the route and fills segment and rest, or makes the reply (404, 405 with Allow). */
void request_route(struct request *request);
/* The methods that the path takes, as Allow lists them; "" if there is no such path. */
void request_methods(struct request *request, char methods[REQUEST_METHODS_SIZE]);
const char *request_header(const struct request *request, const char *name);
/* Refuses query parameters that the operation of the route does not list, or whose values it does
 * not allow. Every request goes through it before its handler. False: the reply is made. */
bool request_query_check(struct request *request);
/* 422 over a query parameter. */
void request_query_refuse(struct request *request, const char *parameter, const char *detail);
/* A number in the query, or its preset without one. */
double request_query_number(const struct request *request, const char *name);
/* Reads the job that the path names. False: the reply is made. */
bool request_job(struct request *request, struct job *job);
/* Its folder, of which the caller is the owner, or NULL with the reply made; the job exists. */
char *request_folder(struct request *request);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
#include "request.h"

#include "identifier.h"
#include "jobs.h"
#include "service.h"
#include "suggest.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct route request_routes[] = {
#define ROUTE(method, path, lane, role, handler)                                                   \
    {#method, path, #handler, LANE_##lane, ROLE_##role, handle_##handler, &operation_##handler},
#include "routes.def"
#undef ROUTE
};
const size_t request_route_count = sizeof request_routes / sizeof request_routes[0];

/* Joins segments from `index` on with slashes; false if they do not fit. */
static bool segments_join(const struct target *target, size_t index, char *rest, size_t size)
{
    size_t length = 0;
    rest[0] = '\0';
    for (; index < target->segment_count; index++) {
        int added = snprintf(rest + length, size - length, "%s%s", length == 0 ? "" : "/",
                             target->segments[index]);
        if (added < 0 || (size_t)added >= size - length)
            return false;
        length += (size_t)added;
    }
    return true;
}

/* Whether the pattern covers the target; on success the wildcards are filled in. */
static bool route_matches(const struct route *route, struct request *request)
{
    const char *pattern = route->path;
    const struct target *target = &request->target;
    bool captured = false;
    for (size_t index = 0;; index++) {
        size_t length = strcspn(pattern, "/");
        const char *suffix = pattern + 1; /* "*.png": a segment that ends so */
        if (length == 2 && pattern[0] == '*')
            return index < target->segment_count &&
                   segments_join(target, index, request->rest, sizeof request->rest);
        if (index >= target->segment_count)
            return false;
        const char *segment = target->segments[index];
        if (pattern[0] == '*') {
            const size_t tail = length - 1, whole = strlen(segment);
            if (whole < tail || strncmp(segment + whole - tail, suffix, tail) != 0)
                return false;
            if (captured)
                (void)snprintf(request->rest, sizeof request->rest, "%.*s", (int)(whole - tail),
                               segment);
            else
                request->segment = segment;
            captured = true;
        } else if (strlen(segment) != length || strncmp(segment, pattern, length) != 0) {
            return false;
        }
        if (pattern[length] == '\0')
            return index + 1 == target->segment_count;
        pattern += length + 1;
    }
}

const struct json_field operation_job_path[] = {{.key = "id", .meaning = "of the job"},
                                                OPERATION_END};

void request_methods(struct request *request, char methods[REQUEST_METHODS_SIZE])
{
    methods[0] = '\0';
    for (size_t index = 0; index < request_route_count; index++) {
        const struct route *route = &request_routes[index];
        size_t length = strlen(methods);
        if (route_matches(route, request))
            (void)snprintf(methods + length, REQUEST_METHODS_SIZE - length, "%s%s%s",
                           length == 0 ? "" : ", ", route->method,
                           strcmp(route->method, "GET") == 0 ? ", HEAD" : "");
    }
}

void request_route(struct request *request)
{
    char allow[REQUEST_METHODS_SIZE];
    const char *method = strcmp(request->method, "HEAD") == 0 ? "GET" : request->method;
    for (size_t index = 0; index < request_route_count; index++) {
        const struct route *route = &request_routes[index];
        if (strcmp(route->method, method) == 0 && route_matches(route, request)) {
            request->route = route;
            return;
        }
    }
    request_methods(request, allow);
    if (allow[0] == '\0') {
        reply_problem(&request->reply, MHD_HTTP_NOT_FOUND, "not_found", request->raw, NULL,
                      "there is nothing at this path");
        return;
    }
    reply_problem(&request->reply, MHD_HTTP_METHOD_NOT_ALLOWED, "method", request->raw, NULL,
                  "%s does not apply here; allowed: %s", request->method, allow);
    reply_header(&request->reply, MHD_HTTP_HEADER_ALLOW, allow);
}

const char *request_header(const struct request *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_HEADER_KIND, name);
}

bool request_job(struct request *request, struct job *job)
{
    struct talus_error error = {0};
    memset(job, 0, sizeof *job);
    if (!identifier_valid(request->segment)) {
        reply_problem(&request->reply, MHD_HTTP_NOT_FOUND, "not_found", request->raw, NULL,
                      "there is no such job");
        return false;
    }
    if (store_job_read(request->service->store, request->segment, job, &error) != TALUS_OK) {
        reply_error(&request->reply, request->raw, &error);
        return false;
    }
    return true;
}

char *request_folder(struct request *request)
{
    struct job job;
    if (!request_job(request, &job))
        return NULL;
    char *folder = jobs_folder(request->service, job.id);
    job_release(&job);
    if (folder == NULL) {
        const struct talus_error error = {.code = "memory", .text = "out of memory"};
        reply_error(&request->reply, request->raw, &error);
    }
    return folder;
}

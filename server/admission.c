/* SPDX-License-Identifier: Apache-2.0 */
#include "admission.h"

#include "folder.h"
#include "json_text.h"
#include "service.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { KEY_BYTES_MAX = 255 };

bool admission_draining(struct request *request)
{
    if (!atomic_load(&request->service->draining))
        return false;
    reply_problem(&request->reply, MHD_HTTP_SERVICE_UNAVAILABLE, "draining", request->raw, NULL,
                  "the daemon is stopping; its jobs go on under the next one");
    return true;
}

const struct json_field admission_key_headers[] = {
    {.key = "Idempotency-Key",
     .optional = true,
     .most = KEY_BYTES_MAX,
     .meaning = "the same key and an equal body make one thing, however often they are sent"},
    OPERATION_END};

const char *const admission_made_headers[] = {"ETag", "Location", "Idempotent-Replayed", NULL};

bool admission_key(struct request *request, const json_t *body, struct admission *admission)
{
    struct talus_error error = {0};
    const char *value = request_header(request, "Idempotency-Key");
    *admission = (struct admission){.result = STORE_INSERTED};
    if (value == NULL)
        return true;
    if (value[0] == '\0' || strlen(value) > KEY_BYTES_MAX) {
        reply_problem(&request->reply, MHD_HTTP_BAD_REQUEST, "idempotency_key", request->raw, NULL,
                      "an Idempotency-Key has 1 to %d bytes", KEY_BYTES_MAX);
        return false;
    }
    admission->key = (struct store_key){
        .owner = request->principal.name, .key = value, .body = admission->checksum};
    if (checksum_json(body, admission->checksum, &error) == TALUS_OK &&
        store_key_find(request->service->store, &admission->key, &admission->result,
                       admission->existing, &error) == TALUS_OK)
        return true;
    reply_error(&request->reply, request->raw, &error);
    return false;
}

void admission_other_body(struct request *request)
{
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "idempotency_key", request->raw,
                  NULL, "this Idempotency-Key came with another body before");
}

void admission_made(struct request *request, const char *path, const char *id, bool replayed)
{
    char location[128];
    (void)snprintf(location, sizeof location, "%s%s", path, id);
    reply_header(&request->reply, MHD_HTTP_HEADER_LOCATION, location);
    if (replayed)
        reply_header(&request->reply, "Idempotent-Replayed", "true");
}

bool admission_disk(struct request *request, double bytes)
{
    const double free_bytes = folder_free_bytes(request->service->state);
    double left = free_bytes - request->service->config->disk_reserve_bytes;
    if (free_bytes < 0 || bytes <= left)
        return true;
    left = left < 0 ? 0 : left;
    json_t *numbers = json_pack("{s:o, s:o}", "needed_bytes", json_number_make(ceil(bytes)),
                                "free_bytes", json_number_make(floor(left)));
    reply_problem_with(&request->reply, MHD_HTTP_INSUFFICIENT_STORAGE, "disk", request->raw,
                       numbers, "the results need %.3g bytes and %.3g are free", bytes, left);
    return false;
}

void admission_errors(json_t *errors, const json_t *found, const char *prefix)
{
    size_t index;
    json_t *issue;
    json_array_foreach(found, index, issue)
    {
        const char *pointer = json_string_value(json_object_get(issue, "pointer"));
        json_t *copy = json_copy(issue);
        json_t *full = json_sprintf("%s%s", prefix, pointer == NULL ? "" : pointer);
        (void)json_object_set_new(copy, "pointer", full);
        (void)json_array_append_new(errors, copy);
    }
}

void admission_refused(struct request *request, json_t *errors)
{
    size_t count = json_array_size(errors);
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "invalid", request->raw,
                  json_incref(errors), "the request has %zu mistake%s", count,
                  count == 1 ? "" : "s");
}

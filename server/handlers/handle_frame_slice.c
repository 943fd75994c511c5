/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/jobs/ID/frames/N: a frame as arrays of float32, cut by a helper. */
#include "conditional.h"
#include "folder.h"
#include "frame_index.h"
#include "helper.h"
#include "request.h"
#include "service.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char slices_folder[] = ".pictures";

/* Whether a name is in an array of names. */
static bool is_listed(const json_t *names, const char *name, size_t length)
{
    size_t index;
    const json_t *other;
    json_array_foreach(names, index, other)
    {
        const char *text = json_string_value(other);
        if (text != NULL && strlen(text) == length && strncmp(text, name, length) == 0)
            return true;
    }
    return false;
}

static void field_refused(struct request *request, const char *field, size_t length, json_t *all)
{
    json_t *errors = json_array();
    json_t *given = json_stringn(field, length);
    issue_add(errors, "", "unknown_value", given, all, "the frame has no field '%.*s'",
              (int)(length < 64 ? length : 64), field);
    (void)json_object_set_new(json_array_get(errors, 0), "parameter", json_string("fields"));
    json_decref(given);
    reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "query", request->raw, errors,
                  "the frame does not have every field that is asked for");
}

/* The fields that the query asks for, all of them by default, without positions, which come always;
 * new reference, or NULL with the reply made. */
static json_t *fields_read(struct request *request, json_t *all)
{
    const char *text = target_query(&request->target, "fields");
    if (text == NULL)
        return json_incref(all);
    json_t *fields = json_array();
    for (const char *field = text; field != NULL; field = strchr(field, ',')) {
        field += *field == ',';
        size_t length = strcspn(field, ",");
        if (length == strlen("position") && strncmp(field, "position", length) == 0)
            continue;
        if (!is_listed(all, field, length)) {
            field_refused(request, field, length, all);
            json_decref(fields);
            return NULL;
        }
        if (!is_listed(fields, field, length))
            (void)json_array_append_new(fields, json_stringn(field, length));
    }
    return fields;
}

/* Has a slice written aside; its descriptor, after which no name is left, or -1 with the reply
 * made. */
static int slice_cut(struct request *request, const char *folder, json_int_t frame, json_t *fields)
{
    struct talus_error error = {0};
    json_t *answer = NULL;
    char aside[64];
    int descriptor = -1;
    (void)snprintf(aside, sizeof aside, "%p.f32", (void *)request);
    char *slices = folder_join(folder, slices_folder);
    char *output = slices == NULL ? NULL : folder_join(slices, aside);
    json_t *question =
        json_pack("{s:s, s:s, s:I, s:O, s:I, s:s}", "op", "slice", "folder", folder, "frame", frame,
                  "fields", fields, "stride", (json_int_t)request_query_number(request, "stride"),
                  "output", output == NULL ? "" : output);
    enum talus_status status = output == NULL || question == NULL ? talus_error_memory(&error)
                                                                  : folder_make(slices, &error);
    if (status == TALUS_OK)
        status = helper_ask(request->helper, question, request->service->config->render_seconds,
                            &answer, &error);
    if (status == TALUS_OK && json_is_true(json_object_get(answer, "ok")))
        descriptor = open(output, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (status != TALUS_OK)
        reply_error(&request->reply, request->raw, &error);
    else if (descriptor < 0)
        reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "slice", request->raw,
                      json_incref(json_object_get(answer, "errors")), "the frame cannot be sliced");
    if (output != NULL)
        (void)unlink(output);
    json_decref(question);
    json_decref(answer);
    free(output);
    free(slices);
    return descriptor;
}

static void slice_etag(const struct request *request, const json_t *frame, const json_t *fields,
                       char etag[CONDITIONAL_ETAG_SIZE])
{
    json_t *key = json_pack("[O?, O, I]", json_object_get(frame, "sha256"), fields,
                            (json_int_t)request_query_number(request, "stride"));
    char *text = key == NULL ? NULL : json_dumps(key, JSON_COMPACT);
    etag[0] = '\0';
    if (text != NULL)
        conditional_etag(text, strlen(text), etag);
    free(text);
    json_decref(key);
}

static void slice_reply(struct request *request, const char *folder, const json_t *frame,
                        json_int_t number)
{
    struct stat information = {.st_size = 0};
    char etag[CONDITIONAL_ETAG_SIZE];
    json_t *fields = fields_read(request, json_object_get(frame, "fields"));
    if (fields == NULL)
        return;
    slice_etag(request, frame, fields, etag);
    if (!conditional_reply(request, etag)) {
        int descriptor = slice_cut(request, folder, number, fields);
        if (descriptor >= 0 && fstat(descriptor, &information) == 0) {
            reply_file(&request->reply, MHD_HTTP_OK, "application/octet-stream", descriptor, 0,
                       (uint64_t)information.st_size);
            conditional_mark(request, etag);
            reply_header(&request->reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
        }
    }
    json_decref(fields);
}

const struct operation operation_frame_slice = {
    .summary = "A frame as arrays: a uint32, the length of the JSON header behind it ({frame, "
               "count, stride, fields: [{name, components, offset, unit}]}, padded to 4 bytes), "
               "then, at the offsets from the end of the header, float32; all little-endian",
    .path =
        (const struct json_field[]){
            {.key = "id", .meaning = "of the job"},
            {.key = "n", .kind = FIELD_INTEGER, .meaning = "number of the frame"},
            OPERATION_END},
    .query =
        (const struct json_field[]){
            {.key = "fields",
             .kind = FIELD_TEXT,
             .optional = true,
             .meaning = "names with commas between; default: all; 'position' comes always"},
            {.key = "stride",
             .kind = FIELD_INTEGER,
             .optional = true,
             .minimum = 1,
             .maximum = 1e9,
             .preset = 1,
             .meaning = "every so many particles, in the order of their ids"},
            {.key = "format",
             .kind = FIELD_TEXT,
             .optional = true,
             .words = (const char *const[]){"f32", NULL},
             .meaning = "float32"},
            OPERATION_END},
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/octet-stream",
                                            .headers = conditional_headers,
                                            .meaning = "header and arrays"},
                                           CONDITIONAL_UNCHANGED,
                                           RESPONSE_END},
    .problems = conditional_problems,
};

enum handled handle_frame_slice(struct request *request)
{
    const json_int_t number = frame_index_number(request->rest);
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    json_t *frames = frame_index_read(folder);
    const json_t *frame = frame_index_find(frames, number);
    if (number < 0 || frame == NULL)
        reply_problem(&request->reply, MHD_HTTP_NOT_FOUND, "not_found", request->raw, NULL,
                      "the job has no frame %s", request->rest);
    else
        slice_reply(request, folder, frame, number);
    json_decref(frames);
    free(folder);
    return HANDLED;
}

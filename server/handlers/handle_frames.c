/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/jobs/ID/frames and /frames/N.png; pictures are drawn by a helper and kept in the job's
 * folder. */
#include "conditional.h"
#include "folder.h"
#include "frame_index.h"
#include "helper.h"
#include "request.h"
#include "schemas.h"
#include "service.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WIDTH_MIN = 64, WIDTH_MAX = 4096, WIDTH_DEFAULT = 800 };
static const char pictures_folder[] = ".pictures";

/* What is to be drawn; texts are borrowed. */
struct picture {
    json_int_t frame;
    const char *field, *style;
    int width;
    char name[256]; /* of the file in the pictures' folder */
};

static void frames_unreadable(struct request *request)
{
    const struct talus_error error = {.code = "io", .text = "the events cannot be read"};
    reply_error(&request->reply, request->raw, &error);
}

const struct operation operation_frame_list = {
    .summary = "The frames of a job so far",
    .path = operation_job_path,
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_frame_list,
                                            .headers = conditional_headers,
                                            .meaning = "all frames, in the order of time"},
                                           CONDITIONAL_UNCHANGED,
                                           RESPONSE_END},
    .problems = conditional_problems,
};

enum handled handle_frame_list(struct request *request)
{
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    json_t *frames = frame_index_read(folder);
    free(folder);
    if (frames == NULL)
        frames_unreadable(request);
    else
        conditional_document(request, "application/json", frames);
    return HANDLED;
}

/* Fills in what the query leaves open. False: the reply is made. */
static bool picture_describe(struct request *request, const json_t *frame, struct picture *picture)
{
    const json_t *fields = json_object_get(frame, "fields");
    const json_t *sha256 = json_object_get(frame, "sha256");
    picture->width = (int)request_query_number(request, "width");
    picture->field = target_query(&request->target, "field");
    if (picture->field == NULL)
        picture->field = json_string_value(json_array_get(fields, 0));
    if (picture->field == NULL)
        picture->field = "velocity";
    picture->style = target_query(&request->target, "style");
    if (picture->style == NULL)
        picture->style = "points";
    if (strspn(picture->field, "abcdefghijklmnopqrstuvwxyz0123456789_.") !=
            strlen(picture->field) ||
        strlen(picture->field) > 64) {
        reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "query", request->raw, NULL,
                      "a field of the frame is wanted");
        return false;
    }
    const char *hash = json_string_value(sha256);
    (void)snprintf(picture->name, sizeof picture->name, "%lld-%.16s-%s-%s-%d.png",
                   (long long)picture->frame, hash == NULL ? "" : hash, picture->field,
                   picture->style, picture->width);
    return true;
}

/* Has a picture drawn aside and put in its place. False: the reply is made. */
static bool picture_draw(struct request *request, const char *folder, const char *pictures,
                         const struct picture *picture)
{
    struct talus_error error = {0};
    json_t *answer = NULL;
    char aside[320];
    (void)snprintf(aside, sizeof aside, "%s.%p.tmp", picture->name, (void *)request);
    char *output = folder_join(pictures, aside), *path = folder_join(pictures, picture->name);
    json_t *question =
        json_pack("{s:s, s:s, s:I, s:s, s:i, s:s, s:s}", "op", "render", "folder", folder, "frame",
                  picture->frame, "field", picture->field, "width", picture->width, "style",
                  picture->style, "output", output == NULL ? "" : output);
    enum talus_status status = output == NULL || path == NULL || question == NULL
                                   ? talus_error_memory(&error)
                                   : folder_make(pictures, &error);
    if (status == TALUS_OK)
        status = helper_ask(request->helper, question, request->service->config->render_seconds,
                            &answer, &error);
    bool drawn = status == TALUS_OK && json_is_true(json_object_get(answer, "ok"));
    if (drawn && rename(output, path) != 0) {
        drawn = false;
        status = talus_error_set(&error, TALUS_IO, "io", "", "the picture was not written");
    }
    if (status != TALUS_OK)
        reply_error(&request->reply, request->raw, &error);
    else if (!drawn)
        reply_problem(&request->reply, MHD_HTTP_UNPROCESSABLE_CONTENT, "picture", request->raw,
                      json_incref(json_object_get(answer, "errors")),
                      "the picture cannot be drawn");
    if (!drawn && output != NULL)
        (void)unlink(output);
    json_decref(question);
    json_decref(answer);
    free(output);
    free(path);
    return drawn;
}

static void picture_reply(struct request *request, const char *folder,
                          const struct picture *picture)
{
    struct stat information;
    char etag[CONDITIONAL_ETAG_SIZE];
    char *pictures = folder_join(folder, pictures_folder);
    conditional_etag(picture->name, strlen(picture->name), etag);
    if (pictures == NULL || conditional_reply(request, etag)) {
        free(pictures);
        return;
    }
    int descriptor = folder_open(pictures, picture->name);
    if (descriptor < 0 && picture_draw(request, folder, pictures, picture))
        descriptor = folder_open(pictures, picture->name);
    free(pictures);
    if (descriptor < 0) {
        if (request->reply.response == NULL)
            frames_unreadable(request);
        return;
    }
    if (fstat(descriptor, &information) != 0)
        information.st_size = 0;
    reply_file(&request->reply, MHD_HTTP_OK, "image/png", descriptor, 0,
               (uint64_t)information.st_size);
    conditional_mark(request, etag);
    reply_header(&request->reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
}

const struct operation operation_frame_picture = {
    .summary = "A picture of a frame, with colour bar, axes and title",
    .path =
        (const struct json_field[]){
            {.key = "id", .meaning = "of the job"},
            {.key = "n", .kind = FIELD_INTEGER, .meaning = "number of the frame"},
            OPERATION_END},
    .query = (const struct json_field[]){{.key = "field",
                                          .kind = FIELD_TEXT,
                                          .optional = true,
                                          .meaning = "what the colours show: velocity, stress.xx, "
                                                     "...; default: the first of the frame"},
                                         {.key = "width",
                                          .kind = FIELD_INTEGER,
                                          .optional = true,
                                          .minimum = WIDTH_MIN,
                                          .maximum = WIDTH_MAX,
                                          .preset = WIDTH_DEFAULT,
                                          .meaning = "pixels"},
                                         {.key = "style",
                                          .kind = FIELD_TEXT,
                                          .optional = true,
                                          .words = (const char *const[]){"points", "voxels", NULL},
                                          .meaning = "how particles are drawn; default points"},
                                         OPERATION_END},
    .responses = (const struct response[]){{.status = 200,
                                            .type = "image/png",
                                            .headers = conditional_headers,
                                            .meaning = "the picture"},
                                           CONDITIONAL_UNCHANGED,
                                           RESPONSE_END},
    .problems = conditional_problems,
};

enum handled handle_frame_picture(struct request *request)
{
    struct picture picture = {.frame = frame_index_number(request->rest)};
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    json_t *frames = frame_index_read(folder);
    const json_t *frame = frame_index_find(frames, picture.frame);
    if (frames == NULL)
        frames_unreadable(request);
    else if (picture.frame < 0 || frame == NULL)
        reply_problem(&request->reply, MHD_HTTP_NOT_FOUND, "not_found", request->raw, NULL,
                      "the job has no frame %s", request->rest);
    else if (picture_describe(request, frame, &picture))
        picture_reply(request, folder, &picture);
    json_decref(frames);
    free(folder);
    return HANDLED;
}

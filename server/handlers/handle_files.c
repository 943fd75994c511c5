/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/jobs/ID/files, /files/NAME and /log */
#include "base/protocol.h"
#include "byte_range.h"
#include "conditional.h"
#include "file_checksums.h"
#include "folder.h"
#include "request.h"
#include "schemas.h"
#include "service.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LOG_LINES_DEFAULT = 200, LOG_LINES_MAX = 10000, LOG_BYTES_MAX = 1 << 20 };

static const char *file_type(const char *name)
{
    static const char *const types[][2] = {
        {".json", "application/json"},       {".ndjson", "application/x-ndjson"},
        {".csv", "text/csv; charset=utf-8"}, {".txt", "text/plain; charset=utf-8"},
        {".series", "application/json"},     {".png", "image/png"},
        {".hdf", "application/x-hdf5"},      {".h5", "application/x-hdf5"},
        {".vtu", "application/xml"},         {".pvd", "application/xml"},
    };
    const char *dot = strrchr(name, '.');
    for (size_t index = 0; dot != NULL && index < sizeof types / sizeof types[0]; index++) {
        if (strcmp(dot, types[index][0]) == 0)
            return types[index][1];
    }
    return "application/octet-stream";
}

struct file_list {
    struct file_checksums *checksums;
    const char *folder;
    json_t *files;
};

static bool file_list_add(const char *name, void *context)
{
    struct file_list *list = context;
    struct talus_error error = {0};
    struct stat information;
    char checksum[CHECKSUM_SIZE];
    int descriptor = folder_open(list->folder, name);
    if (descriptor < 0)
        return true;
    if (fstat(descriptor, &information) == 0 &&
        file_checksum(list->checksums, descriptor, checksum, &error) == TALUS_OK)
        (void)json_array_append_new(list->files,
                                    json_pack("{s:s, s:I, s:s}", "name", name, "bytes",
                                              (json_int_t)information.st_size, "sha256", checksum));
    (void)close(descriptor);
    return true;
}

const struct operation operation_file_list = {
    .summary = "The files of a job, with sizes and SHA-256",
    .path = operation_job_path,
    .responses = (const struct response[]){{.status = 200,
                                            .type = "application/json",
                                            .schema = &schema_file_list,
                                            .headers = conditional_headers,
                                            .meaning = "all files"},
                                           CONDITIONAL_UNCHANGED,
                                           RESPONSE_END},
    .problems = conditional_problems,
};

enum handled handle_file_list(struct request *request)
{
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    struct file_list list = {
        .checksums = request->service->checksums, .folder = folder, .files = json_array()};
    folder_list(folder, file_list_add, &list);
    free(folder);
    conditional_document(request, "application/json", list.files);
    return HANDLED;
}

/* Changes whenever the bytes do: files are appended to or replaced, never edited in place. */
static void file_etag(const struct stat *information, char etag[80])
{
    (void)snprintf(etag, 80, "\"%jx-%jx-%jx.%lx\"", (uintmax_t)information->st_ino,
                   (uintmax_t)information->st_size, (uintmax_t)information->st_mtim.tv_sec,
                   (unsigned long)information->st_mtim.tv_nsec);
}

/* Answers with a file or the part that is asked for; takes the descriptor. */
static void file_reply(struct request *request, int descriptor, const struct stat *information)
{
    char etag[80], range_text[96];
    uint64_t size = (uint64_t)information->st_size, first = 0, length = size;
    const char *range = request_header(request, MHD_HTTP_HEADER_RANGE);
    const char *if_range = request_header(request, MHD_HTTP_HEADER_IF_RANGE);
    struct reply *reply = &request->reply;
    file_etag(information, etag);
    if (if_range != NULL && strcmp(if_range, etag) != 0)
        range = NULL;
    enum byte_range kind = byte_range_parse(range, size, &first, &length);
    if (conditional_reply(request, etag)) {
        (void)close(descriptor);
        return;
    }
    if (kind == BYTE_RANGE_UNSATISFIABLE) {
        reply_problem(reply, MHD_HTTP_RANGE_NOT_SATISFIABLE, "range", request->raw, NULL,
                      "the file has %" PRIu64 " bytes", size);
        (void)snprintf(range_text, sizeof range_text, "bytes */%" PRIu64, size);
        reply_header(reply, MHD_HTTP_HEADER_CONTENT_RANGE, range_text);
    } else {
        reply_file(reply, kind == BYTE_RANGE_PART ? MHD_HTTP_PARTIAL_CONTENT : MHD_HTTP_OK,
                   file_type(request->rest), descriptor, first, length);
        descriptor = -1;
        (void)snprintf(range_text, sizeof range_text, "bytes %" PRIu64 "-%" PRIu64 "/%" PRIu64,
                       first, first + length - 1, size);
        if (kind == BYTE_RANGE_PART)
            reply_header(reply, MHD_HTTP_HEADER_CONTENT_RANGE, range_text);
        reply_header(reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-cache");
    }
    conditional_mark(request, etag);
    reply_header(reply, MHD_HTTP_HEADER_ACCEPT_RANGES, "bytes");
    if (descriptor >= 0)
        (void)close(descriptor);
}

static const char *const file_headers[] = {"ETag", "Accept-Ranges", NULL};
static const char *const part_headers[] = {"ETag", "Accept-Ranges", "Content-Range", NULL};

const struct operation operation_file = {
    .summary = "A file of a job, or a part of it",
    .path = (const struct json_field[]){{.key = "id", .meaning = "of the job"},
                                        {.key = "name",
                                         .meaning = "of the file, in which slashes stay as they "
                                                    "are: frames/frame_000000.hdf"},
                                        OPERATION_END},
    .headers =
        (const struct json_field[]){
            {.key = "Range", .optional = true, .meaning = "bytes=FIRST-LAST: this part only"},
            {.key = "If-Range", .optional = true, .meaning = "the part only of this ETag"},
            {.key = "If-Match", .optional = true, .meaning = "only the file with this ETag"},
            {.key = "If-None-Match", .optional = true, .meaning = "only another than this ETag"},
            OPERATION_END},
    .responses =
        (const struct response[]){
            {.status = 200, .type = "*/*", .headers = file_headers, .meaning = "the whole file"},
            {.status = 206,
             .type = "*/*",
             .headers = part_headers,
             .meaning = "the part that was asked for"},
            {.status = 304, .headers = file_headers, .meaning = "it is the one with this ETag"},
            RESPONSE_END},
    .problems = (const unsigned int[]){412, 416, 0},
};

enum handled handle_file(struct request *request)
{
    struct stat information;
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    int descriptor = folder_name_public(request->rest) ? folder_open(folder, request->rest) : -1;
    free(folder);
    if (descriptor >= 0 && fstat(descriptor, &information) == 0) {
        file_reply(request, descriptor, &information);
        return HANDLED;
    }
    if (descriptor >= 0)
        (void)close(descriptor);
    reply_problem(&request->reply, MHD_HTTP_NOT_FOUND, "not_found", request->raw, NULL,
                  "the job has no file %s", request->rest);
    return HANDLED;
}

/* The last `lines` lines of a file, at most LOG_BYTES_MAX bytes. */
static void log_tail(int descriptor, size_t lines, struct text *text)
{
    off_t size = lseek(descriptor, 0, SEEK_END);
    off_t begin = size > LOG_BYTES_MAX ? size - LOG_BYTES_MAX : 0;
    char *buffer = malloc(LOG_BYTES_MAX);
    ssize_t length = buffer == NULL ? -1 : pread(descriptor, buffer, LOG_BYTES_MAX, begin);
    size_t start = length > 0 ? (size_t)length : 0, found = 0;
    while (start > 0 && length > 0) {
        if (buffer[start - 1] == '\n' && start < (size_t)length && ++found == lines)
            break;
        start--;
    }
    if (length > 0)
        text_add(text, buffer + start, (size_t)length - start);
    free(buffer);
}

const struct operation operation_job_log = {
    .summary = "The end of the worker's log",
    .path = operation_job_path,
    .query = (const struct json_field[]){{.key = "tail",
                                          .kind = FIELD_INTEGER,
                                          .optional = true,
                                          .minimum = 1,
                                          .maximum = LOG_LINES_MAX,
                                          .preset = LOG_LINES_DEFAULT,
                                          .meaning = "so many lines"},
                                         OPERATION_END},
    .responses = (const struct response[]){{.status = 200,
                                            .type = "text/plain; charset=utf-8",
                                            .meaning = "the last lines, a mebibyte at most"},
                                           RESPONSE_END},
};

enum handled handle_job_log(struct request *request)
{
    double lines = request_query_number(request, "tail");
    struct text text = {0};
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    int descriptor = folder_open(folder, PROTOCOL_LOG_FILE);
    free(folder);
    if (descriptor >= 0) {
        log_tail(descriptor, (size_t)lines, &text);
        (void)close(descriptor);
    }
    reply_text(&request->reply, MHD_HTTP_OK, "text/plain; charset=utf-8", &text);
    reply_header(&request->reply, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
    return HANDLED;
}

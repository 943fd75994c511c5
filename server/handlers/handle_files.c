/* SPDX-License-Identifier: Apache-2.0 */
/* GET /v1/jobs/ID/files, /files/NAME and /log */
#include "base/protocol.h"
#include "byte_range.h"
#include "file_checksums.h"
#include "folder.h"
#include "request.h"
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

enum handled handle_file_list(struct request *request)
{
    static const char *const allowed[] = {NULL};
    if (!request_query_check(request, allowed))
        return HANDLED;
    char *folder = request_folder(request);
    if (folder == NULL)
        return HANDLED;
    struct file_list list = {
        .checksums = request->service->checksums, .folder = folder, .files = json_array()};
    folder_list(folder, file_list_add, &list);
    free(folder);
    reply_json(&request->reply, MHD_HTTP_OK, list.files);
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
    const char *match = request_header(request, MHD_HTTP_HEADER_IF_MATCH);
    const char *none_match = request_header(request, MHD_HTTP_HEADER_IF_NONE_MATCH);
    const char *range = request_header(request, MHD_HTTP_HEADER_RANGE);
    const char *if_range = request_header(request, MHD_HTTP_HEADER_IF_RANGE);
    struct reply *reply = &request->reply;
    file_etag(information, etag);
    if (if_range != NULL && strcmp(if_range, etag) != 0)
        range = NULL;
    enum byte_range kind = byte_range_parse(range, size, &first, &length);
    if (match != NULL && !etag_listed(match, etag, false)) {
        reply_problem(reply, MHD_HTTP_PRECONDITION_FAILED, "changed", request->raw, NULL,
                      "the file is another one by now");
    } else if (none_match != NULL && etag_listed(none_match, etag, true)) {
        reply_empty(reply, MHD_HTTP_NOT_MODIFIED);
    } else if (kind == BYTE_RANGE_UNSATISFIABLE) {
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
    reply_header(reply, MHD_HTTP_HEADER_ETAG, etag);
    reply_header(reply, MHD_HTTP_HEADER_ACCEPT_RANGES, "bytes");
    if (descriptor >= 0)
        (void)close(descriptor);
}

enum handled handle_file(struct request *request)
{
    static const char *const allowed[] = {NULL};
    struct stat information;
    if (!request_query_check(request, allowed))
        return HANDLED;
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

enum handled handle_job_log(struct request *request)
{
    static const char *const allowed[] = {"tail", NULL};
    double lines;
    struct text text = {0};
    if (!request_query_check(request, allowed) ||
        !request_query_number(request, "tail", 1, LOG_LINES_MAX, LOG_LINES_DEFAULT, &lines))
        return HANDLED;
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

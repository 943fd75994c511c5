/* SPDX-License-Identifier: Apache-2.0 */
#include "output/history.h"

#include "base/protocol.h"
#include "output/file.h"
#include "output/lenient_text.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes of rows that wait at most before they are written. */
enum { BUFFER_BYTES = 1 << 18 };

static enum talus_status write_columns(const char *folder, const struct talus_column *columns,
                                       size_t count, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    enum talus_status status = file_path(path, folder, PROTOCOL_HISTORY_COLUMNS_FILE, error);
    if (status != TALUS_OK)
        return status;
    json_t *list = json_array();
    for (size_t index = 0; index < count; index++) {
        if (json_array_append_new(list, json_pack("{s:o, s:o}", "name",
                                                  lenient_text_json(columns[index].name), "unit",
                                                  lenient_text_json(columns[index].unit))) != 0) {
            json_decref(list);
            return file_error(error, ENOMEM, "write", path);
        }
    }
    json_t *root =
        json_pack("{s:o, s:I}", "columns", list, "row_bytes", (json_int_t)(count * sizeof(double)));
    char *text = root == NULL ? NULL : json_dumps(root, JSON_INDENT(1));
    status = text == NULL ? file_error(error, ENOMEM, "write", path)
                          : file_write_whole(path, text, strlen(text), error);
    free(text);
    json_decref(root);
    return status;
}

/* Cuts the file to its first `keep` rows; appending then goes on behind them. */
static enum talus_status cut_rows(const struct history *history, const char *path, uint64_t keep,
                                  struct talus_error *error)
{
    struct stat information;
    off_t size = (off_t)(keep * history->column_count * sizeof(double));
    if (fstat(history->descriptor, &information) != 0)
        return file_error(error, errno, "inspect", path);
    if (information.st_size < size)
        return talus_error_set(error, TALUS_IO, "io", "", "%s holds fewer than %llu rows", path,
                               (unsigned long long)keep);
    if (ftruncate(history->descriptor, size) != 0)
        return file_error(error, errno, "cut", path);
    return TALUS_OK;
}

enum talus_status history_open(struct history *history, const char *folder,
                               const struct talus_column *columns, size_t column_count,
                               uint64_t keep, struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    memset(history, 0, sizeof *history);
    history->descriptor = -1;
    enum talus_status status = file_path(path, folder, PROTOCOL_HISTORY_FILE, error);
    if (status == TALUS_OK)
        status = write_columns(folder, columns, column_count, error);
    if (status != TALUS_OK)
        return status;
    size_t row_bytes = column_count * sizeof(double);
    history->column_count = column_count;
    history->capacity = row_bytes < BUFFER_BYTES ? BUFFER_BYTES / row_bytes : 1;
    history->row_count = keep;
    history->written = keep;
    history->buffer = malloc(history->capacity * row_bytes);
    if (history->buffer == NULL)
        return file_error(error, ENOMEM, "write", path);
    history->descriptor = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (history->descriptor < 0)
        return file_error(error, errno, "open", path);
    return cut_rows(history, path, keep, error);
}

enum talus_status history_add(struct history *history, double **row, struct talus_error *error)
{
    if (history->row_count - history->written == history->capacity) {
        enum talus_status status = history_flush(history, error);
        if (status != TALUS_OK)
            return status;
    }
    *row = history->buffer + (history->row_count - history->written) * history->column_count;
    history->row_count++;
    return TALUS_OK;
}

enum talus_status history_flush(struct history *history, struct talus_error *error)
{
    size_t row_bytes = history->column_count * sizeof(double);
    size_t bytes = (size_t)(history->row_count - history->written) * row_bytes;
    if (bytes == 0)
        return TALUS_OK;
    int failure = file_write_all(history->descriptor, history->buffer, bytes);
    if (failure != 0) {
        /* Whole rows only; should this fail too, readers cut a torn row anyway. */
        if (ftruncate(history->descriptor, (off_t)(history->written * row_bytes)) != 0)
            failure = errno;
        return file_error(error, failure, "append to", PROTOCOL_HISTORY_FILE);
    }
    history->written = history->row_count;
    return TALUS_OK;
}

enum talus_status history_sync(const struct history *history, struct talus_error *error)
{
    if (fsync(history->descriptor) != 0)
        return file_error(error, errno, "sync", PROTOCOL_HISTORY_FILE);
    return TALUS_OK;
}

void history_close(struct history *history)
{
    if (history->descriptor >= 0)
        (void)close(history->descriptor);
    free(history->buffer);
    memset(history, 0, sizeof *history);
    history->descriptor = -1;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "history_reader.h"

#include "base/protocol.h"
#include "folder.h"
#include "json_file.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static enum talus_status columns_copy(struct history_reader *history, const json_t *columns,
                                      struct talus_error *error)
{
    size_t count = json_array_size(columns);
    history->columns = calloc(count, sizeof *history->columns);
    if (history->columns == NULL)
        return talus_error_memory(error);
    history->column_count = count;
    for (size_t index = 0; index < count; index++) {
        const json_t *column = json_array_get(columns, index);
        const char *name = json_string_value(json_object_get(column, "name"));
        const char *unit = json_string_value(json_object_get(column, "unit"));
        history->columns[index].name = strdup(name == NULL ? "" : name);
        history->columns[index].unit = strdup(unit == NULL ? "" : unit);
        if (history->columns[index].name == NULL || history->columns[index].unit == NULL)
            return talus_error_memory(error);
    }
    return TALUS_OK;
}

enum talus_status history_reader_open(struct history_reader *history, const char *folder,
                                      struct talus_error *error)
{
    memset(history, 0, sizeof *history);
    history->descriptor = folder_open(folder, PROTOCOL_HISTORY_FILE);
    json_t *root = json_file_load(folder, PROTOCOL_HISTORY_COLUMNS_FILE);
    const json_t *columns = json_object_get(root, "columns");
    enum talus_status status;
    if (history->descriptor < 0 || json_array_size(columns) < 1)
        status =
            talus_error_set(error, TALUS_INVALID, "not_found", "", "the job has no history yet");
    else
        status = columns_copy(history, columns, error);
    json_decref(root);
    if (status != TALUS_OK)
        history_reader_close(history);
    return status;
}

void history_reader_close(struct history_reader *history)
{
    for (size_t index = 0; index < history->column_count; index++) {
        free(history->columns[index].name);
        free(history->columns[index].unit);
    }
    free(history->columns);
    if (history->descriptor >= 0)
        (void)close(history->descriptor);
    memset(history, 0, sizeof *history);
    history->descriptor = -1;
}

int64_t history_reader_row_count(const struct history_reader *history)
{
    struct stat information;
    if (fstat(history->descriptor, &information) != 0)
        return 0;
    return (int64_t)information.st_size / (int64_t)(history->column_count * sizeof(double));
}

size_t history_reader_find(const struct history_reader *history, const char *name)
{
    size_t index = 0;
    while (index < history->column_count && strcmp(history->columns[index].name, name) != 0)
        index++;
    return index;
}

size_t history_reader_read(const struct history_reader *history, int64_t first, size_t count,
                           double *values)
{
    size_t row_bytes = history->column_count * sizeof(double);
    size_t wanted = count * row_bytes, done = 0;
    while (done < wanted) {
        ssize_t length = pread(history->descriptor, (char *)values + done, wanted - done,
                               first * (int64_t)row_bytes + (int64_t)done);
        if (length <= 0)
            break;
        done += (size_t)length;
    }
    return done / row_bytes;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "base/protocol.h"
#include "output/file.h"
#include "output/history.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static enum talus_status take_columns(struct history_table *table, const json_t *list,
                                      const char *path, struct talus_error *error)
{
    size_t count = json_array_size(list);
    if (count == 0)
        return talus_error_set(error, TALUS_IO, "io", "", "%s names no columns", path);
    table->columns = calloc(count, sizeof *table->columns);
    if (table->columns == NULL)
        return file_error(error, ENOMEM, "read", path);
    table->column_count = count;
    for (size_t index = 0; index < count; index++) {
        const json_t *item = json_array_get(list, index);
        const char *name = json_string_value(json_object_get(item, "name"));
        const char *unit = json_string_value(json_object_get(item, "unit"));
        struct talus_column *column = &table->columns[index];
        if (name == NULL || unit == NULL)
            return talus_error_set(error, TALUS_IO, "io", "", "%s: column %zu lacks name or unit",
                                   path, index);
        (void)snprintf(column->name, sizeof column->name, "%s", name);
        (void)snprintf(column->unit, sizeof column->unit, "%s", unit);
    }
    return TALUS_OK;
}

static enum talus_status read_columns(struct history_table *table, const char *folder,
                                      struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    json_error_t mistake;
    enum talus_status status = file_path(path, folder, PROTOCOL_HISTORY_COLUMNS_FILE, error);
    if (status != TALUS_OK)
        return status;
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &mistake);
    if (root == NULL)
        return talus_error_set(error, TALUS_IO, "io", "", "cannot read %s: %s", path, mistake.text);
    status = take_columns(table, json_object_get(root, "columns"), path, error);
    json_decref(root);
    return status;
}

static enum talus_status map_rows(struct history_table *table, int descriptor, const char *path,
                                  struct talus_error *error)
{
    struct stat information;
    if (fstat(descriptor, &information) != 0)
        return file_error(error, errno, "inspect", path);
    size_t row_bytes = table->column_count * sizeof(double);
    table->row_count = (uint64_t)information.st_size / row_bytes;
    size_t bytes = (size_t)table->row_count * row_bytes;
    if (bytes == 0)
        return TALUS_OK;
    void *mapped = mmap(NULL, bytes, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (mapped == MAP_FAILED)
        return file_error(error, errno, "map", path);
    table->rows = mapped;
    table->mapped_bytes = bytes;
    return TALUS_OK;
}

enum talus_status history_table_open(struct history_table *table, const char *folder,
                                     struct talus_error *error)
{
    char path[FILE_PATH_SIZE];
    memset(table, 0, sizeof *table);
    enum talus_status status = read_columns(table, folder, error);
    if (status == TALUS_OK)
        status = file_path(path, folder, PROTOCOL_HISTORY_FILE, error);
    if (status == TALUS_OK) {
        int descriptor = open(path, O_RDONLY | O_CLOEXEC);
        status = descriptor < 0 ? file_error(error, errno, "open", path)
                                : map_rows(table, descriptor, path, error);
        if (descriptor >= 0)
            (void)close(descriptor);
    }
    if (status != TALUS_OK)
        history_table_close(table);
    return status;
}

void history_table_close(struct history_table *table)
{
    if (table->mapped_bytes > 0)
        (void)munmap((void *)(uintptr_t)table->rows, table->mapped_bytes);
    free(table->columns);
    memset(table, 0, sizeof *table);
}

size_t history_find_column(const struct history_table *table, const char *name)
{
    size_t index = 0;
    while (index < table->column_count && strcmp(table->columns[index].name, name) != 0)
        index++;
    return index;
}

bool history_interpolate(const struct history_table *table, size_t column, double time,
                         double *value)
{
    uint64_t low = 0, high = table->row_count;
    if (high == 0 || !(time >= history_value(table, 0, 0)) ||
        time > history_value(table, high - 1, 0))
        return false;
    while (high - low > 1) {
        uint64_t middle = low + (high - low) / 2;
        if (history_value(table, middle, 0) <= time)
            low = middle;
        else
            high = middle;
    }
    double begin = history_value(table, low, 0);
    *value = history_value(table, low, column);
    if (time > begin) {
        double share = (time - begin) / (history_value(table, low + 1, 0) - begin);
        *value += share * (history_value(table, low + 1, column) - *value);
    }
    return true;
}

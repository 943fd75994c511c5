/* SPDX-License-Identifier: Apache-2.0 */
#include "output/decimal.h"
#include "output/file.h"
#include "output/history.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool is_chosen(const struct talus_column *column, size_t index, const char *prefix)
{
    return index == 0 || strncmp(column->name, prefix, strlen(prefix)) == 0;
}

static void write_name(FILE *stream, const char *name)
{
    if (strpbrk(name, ",\"\r\n") == NULL) {
        (void)fputs(name, stream);
        return;
    }
    (void)fputc('"', stream);
    for (; *name != '\0'; name++) {
        if (*name == '"')
            (void)fputc('"', stream);
        (void)fputc(*name, stream);
    }
    (void)fputc('"', stream);
}

static void write_number(FILE *stream, double value)
{
    char text[DECIMAL_SIZE];
    (void)fwrite(text, 1, decimal_write(text, value), stream);
}

static bool write_table(FILE *stream, const struct history_table *table, const char *prefix)
{
    for (size_t column = 0; column < table->column_count; column++) {
        if (!is_chosen(&table->columns[column], column, prefix))
            continue;
        if (column > 0)
            (void)fputc(',', stream);
        write_name(stream, table->columns[column].name);
    }
    (void)fputc('\n', stream);
    for (uint64_t row = 0; row < table->row_count && !ferror(stream); row++) {
        for (size_t column = 0; column < table->column_count; column++) {
            if (!is_chosen(&table->columns[column], column, prefix))
                continue;
            if (column > 0)
                (void)fputc(',', stream);
            write_number(stream, history_value(table, row, column));
        }
        (void)fputc('\n', stream);
    }
    return fflush(stream) == 0 && !ferror(stream);
}

enum talus_status history_write_csv(const struct history_table *table, const char *path,
                                    const char *prefix, struct talus_error *error)
{
    char aside[FILE_PATH_SIZE];
    enum talus_status status = file_aside_path(aside, path, error);
    if (status != TALUS_OK)
        return status;
    FILE *stream = fopen(aside, "we");
    if (stream == NULL)
        return file_error(error, errno, "create", aside);
    if (!write_table(stream, table, prefix))
        status = file_error(error, errno, "write", path);
    if (fclose(stream) != 0 && status == TALUS_OK)
        status = file_error(error, errno, "write", path);
    if (status == TALUS_OK)
        return file_publish(aside, path, error);
    (void)unlink(aside);
    return status;
}

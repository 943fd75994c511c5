/* SPDX-License-Identifier: Apache-2.0 */
#include "output/decimal.h"
#include "output/file.h"
#include "output/history.h"

#include <stdio.h>
#include <string.h>

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

/* The columns of a table whose names begin so. */
struct selection {
    const struct history_table *table;
    const char *prefix;
};

static bool write_table(FILE *stream, const void *context)
{
    const struct selection *selection = context;
    const struct history_table *table = selection->table;
    const char *prefix = selection->prefix;
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
    const struct selection selection = {.table = table, .prefix = prefix};
    return file_write_stream(path, write_table, &selection, error);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* history.bin: rows of doubles, column 0 is time; history.json names the columns. */
#ifndef TALUS_HISTORY_READER_H
#define TALUS_HISTORY_READER_H

#include "talus/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct history_column {
    char *name, *unit;
};

/* Owns the descriptor and the columns. */
struct history_reader {
    int descriptor;
    size_t column_count;
    struct history_column *columns;
};

/* Opens the history of a job's folder. TALUS_INVALID, code "not_found", if there is none yet. */
TALUS_MUST_CHECK enum talus_status
history_reader_open(struct history_reader *history, const char *folder, struct talus_error *error);
void history_reader_close(struct history_reader *history);
/* Complete rows by now. */
int64_t history_reader_row_count(const struct history_reader *history);
/* The column of that name, or column_count. */
size_t history_reader_find(const struct history_reader *history, const char *name);
/* Reads rows [first, first + count) into values[count][column_count]; returns how many there
 * were. */
size_t history_reader_read(const struct history_reader *history, int64_t first, size_t count,
                           double *values);

#endif

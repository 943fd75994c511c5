/* SPDX-License-Identifier: Apache-2.0 */
/* history.bin: rows of little-endian doubles, one per sample, appended; history.json names the
 * columns. Column 0 is time; row 0 is t = 0. */
#ifndef TALUS_HISTORY_H
#define TALUS_HISTORY_H

#include "talus/simulation.h"

/* The writer. Rows gather in a buffer until history_flush appends them with one write(2).
 * Invariant: the file holds `written` whole rows; `row_count - written` wait in the buffer. */
struct history {
    int descriptor; /* below 0: closed */
    size_t column_count, capacity;
    uint64_t row_count, written;
    double *buffer; /* [capacity * column_count] */
};

/* Opens history.bin in `folder` for appending, cut to its first `keep` rows (TALUS_IO if it holds
 * fewer), and writes history.json. Close it in any case. */
TALUS_MUST_CHECK enum talus_status history_open(struct history *history, const char *folder,
                                                const struct talus_column *columns,
                                                size_t column_count, uint64_t keep,
                                                struct talus_error *error);
/* The place for the next row, [column_count], which then counts as added; flushes when the buffer
 * is full. */
TALUS_MUST_CHECK enum talus_status history_add(struct history *history, double **row,
                                               struct talus_error *error);
/* All rows are in the file (readable by others). */
TALUS_MUST_CHECK enum talus_status history_flush(struct history *history,
                                                 struct talus_error *error);
/* All rows that are in the file are on the disk. May be called while another thread adds rows. */
TALUS_MUST_CHECK enum talus_status history_sync(const struct history *history,
                                                struct talus_error *error);
void history_close(struct history *history);

/* A history as it lies on the disk, this job's or another's; only whole rows. */
struct history_table {
    size_t column_count;
    struct talus_column *columns;
    uint64_t row_count;
    const double *rows; /* [row_count][column_count], mapped */
    size_t mapped_bytes;
};
TALUS_MUST_CHECK enum talus_status
history_table_open(struct history_table *table, const char *folder, struct talus_error *error);
void history_table_close(struct history_table *table);

/* Value in a row and column. */
static inline double history_value(const struct history_table *table, uint64_t row, size_t column)
{
    return table->rows[row * table->column_count + column];
}

/* Value of a column at `time`, linear between rows; false outside of the rows. */
bool history_interpolate(const struct history_table *table, size_t column, double time,
                         double *value);

/* Column with this name, or column_count. */
size_t history_find_column(const struct history_table *table, const char *name);

/* Writes `time` and all columns whose name starts with `prefix` ("": all) as CSV (RFC 4180),
 * numbers with as many digits as bring back the same bits; replaced at once. */
TALUS_MUST_CHECK enum talus_status history_write_csv(const struct history_table *table,
                                                     const char *path, const char *prefix,
                                                     struct talus_error *error);

/* results.h5: /time, and under /probes, /reactions, /energies and /others one dataset per series
 * (attribute `series`: its full name); /scene and /receipt as JSON text (NULL: left out). */
TALUS_MUST_CHECK enum talus_status results_write(const struct history_table *table,
                                                 const char *path, const char *scene,
                                                 const char *receipt, struct talus_error *error);

#endif

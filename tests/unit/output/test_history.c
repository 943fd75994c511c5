/* SPDX-License-Identifier: Apache-2.0 */
#include "output/history.h"
#include "scratch_folder.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

static const struct talus_column columns[] = {
    {.name = "time", .unit = "s"},
    {.name = "reaction.a,b.force.x", .unit = "N"},
    {.name = "probe.h", .unit = "m"},
};
enum { COLUMN_COUNT = 3 };

/* Appends rows begin..end: time row / 2, then 0.1 times the row, then its square. */
static void add_rows(struct history *history, uint64_t begin, uint64_t end)
{
    struct talus_error error = {.status = TALUS_OK};
    for (uint64_t index = begin; index < end; index++) {
        double *row = NULL;
        assert_int_equal(history_add(history, &row, &error), TALUS_OK);
        row[0] = 0.5 * (double)index;
        row[1] = 0.1 * (double)index;
        row[2] = (double)(index * index);
    }
}

static void write_rows(const char *folder, uint64_t keep, uint64_t end)
{
    struct history history;
    struct talus_error error = {.status = TALUS_OK};
    assert_int_equal(history_open(&history, folder, columns, COLUMN_COUNT, keep, &error), TALUS_OK);
    add_rows(&history, keep, end);
    assert_int_equal(history_flush(&history, &error), TALUS_OK);
    assert_int_equal(history_sync(&history, &error), TALUS_OK);
    history_close(&history);
}

static void rows_come_back(void **state)
{
    struct history_table table;
    struct talus_error error = {.status = TALUS_OK};
    /* More than one buffer of rows. */
    enum { ROW_COUNT = 30000 };
    write_rows(*state, 0, ROW_COUNT);
    assert_int_equal(history_table_open(&table, *state, &error), TALUS_OK);
    assert_int_equal(table.row_count, ROW_COUNT);
    assert_int_equal(table.column_count, COLUMN_COUNT);
    for (uint64_t row = 0; row < ROW_COUNT; row++) {
        assert_true(history_value(&table, row, 1) == 0.1 * (double)row);
        assert_true(history_value(&table, row, 2) == (double)(row * row));
    }
    assert_string_equal(table.columns[1].unit, "N");
    assert_int_equal(history_find_column(&table, "probe.h"), 2);
    assert_int_equal(history_find_column(&table, "probe"), COLUMN_COUNT);
    history_table_close(&table);
}

static void unflushed_rows_are_not_in_the_file(void **state)
{
    char path[SCRATCH_PATH_SIZE];
    struct stat information;
    struct history history;
    struct talus_error error = {.status = TALUS_OK};
    assert_int_equal(history_open(&history, *state, columns, COLUMN_COUNT, 0, &error), TALUS_OK);
    add_rows(&history, 0, 5);
    assert_int_equal(stat(scratch_path(path, *state, "history.bin"), &information), 0);
    assert_int_equal(information.st_size, 0);
    assert_int_equal(history_flush(&history, &error), TALUS_OK);
    assert_int_equal(stat(path, &information), 0);
    assert_int_equal(information.st_size, 5 * COLUMN_COUNT * 8);
    history_close(&history);
}

static void is_cut_to_the_rows_that_stand(void **state)
{
    char path[SCRATCH_PATH_SIZE];
    struct history history;
    struct history_table table;
    struct talus_error error = {.status = TALUS_OK};
    write_rows(*state, 0, 10);
    scratch_append(scratch_path(path, *state, "history.bin"), "torn");
    assert_int_equal(history_table_open(&table, *state, &error), TALUS_OK);
    assert_int_equal(table.row_count, 10);
    history_table_close(&table);
    write_rows(*state, 4, 6);
    assert_int_equal(history_table_open(&table, *state, &error), TALUS_OK);
    assert_int_equal(table.row_count, 6);
    assert_true(history_value(&table, 5, 2) == 25.0);
    history_table_close(&table);
    assert_int_equal(history_open(&history, *state, columns, COLUMN_COUNT, 7, &error), TALUS_IO);
    history_close(&history);
}

static void interpolates_between_rows(void **state)
{
    double value = 0.0;
    struct history_table table;
    struct talus_error error = {.status = TALUS_OK};
    write_rows(*state, 0, 5);
    assert_int_equal(history_table_open(&table, *state, &error), TALUS_OK);
    assert_true(history_interpolate(&table, 2, 1.25, &value));
    assert_true(fabs(value - 6.5) < 1e-15);
    assert_true(history_interpolate(&table, 2, 0.0, &value));
    assert_true(value == 0.0);
    assert_true(history_interpolate(&table, 2, 2.0, &value));
    assert_true(value == 16.0);
    assert_false(history_interpolate(&table, 2, 2.01, &value));
    assert_false(history_interpolate(&table, 2, -0.01, &value));
    assert_false(history_interpolate(&table, 2, (double)NAN, &value));
    history_table_close(&table);
}

static void csv_has_short_exact_numbers_and_quoted_names(void **state)
{
    char path[SCRATCH_PATH_SIZE], text[256];
    struct history_table table;
    struct talus_error error = {.status = TALUS_OK};
    write_rows(*state, 0, 4);
    assert_int_equal(history_table_open(&table, *state, &error), TALUS_OK);
    scratch_path(path, *state, "all.csv");
    assert_int_equal(history_write_csv(&table, path, "", &error), TALUS_OK);
    (void)scratch_read(path, text, sizeof text);
    assert_string_equal(text, "time,\"reaction.a,b.force.x\",probe.h\n0,0,0\n0.5,0.1,1\n1,0.2,4\n"
                              "1.5,0.30000000000000004,9\n");
    assert_int_equal(history_write_csv(&table, path, "reaction.", &error), TALUS_OK);
    (void)scratch_read(path, text, sizeof text);
    assert_string_equal(text, "time,\"reaction.a,b.force.x\"\n0,0\n0.5,0.1\n1,0.2\n"
                              "1.5,0.30000000000000004\n");
    history_table_close(&table);
}

static void a_missing_or_empty_history_is_told(void **state)
{
    struct history_table table;
    struct talus_error error = {.status = TALUS_OK};
    double value = 0.0;
    assert_int_equal(history_table_open(&table, *state, &error), TALUS_IO);
    error = (struct talus_error){.status = TALUS_OK};
    write_rows(*state, 0, 0);
    assert_int_equal(history_table_open(&table, *state, &error), TALUS_OK);
    assert_int_equal(table.row_count, 0);
    assert_false(history_interpolate(&table, 1, 0.0, &value));
    history_table_close(&table);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, scratch_folder_make, scratch_folder_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(rows_come_back),
        TEST(unflushed_rows_are_not_in_the_file),
        TEST(is_cut_to_the_rows_that_stand),
        TEST(interpolates_between_rows),
        TEST(csv_has_short_exact_numbers_and_quoted_names),
        TEST(a_missing_or_empty_history_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

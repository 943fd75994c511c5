/* SPDX-License-Identifier: Apache-2.0 */
#include "output/checkpoint_file.h"
#include "scratch_folder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { BIG = 300000 };

static void blobs_come_back_in_order(void **state)
{
    char path[SCRATCH_PATH_SIZE];
    unsigned char *big = malloc(BIG);
    struct checkpoint checkpoint;
    struct talus_error error = {.status = TALUS_OK};
    assert_non_null(big);
    for (size_t index = 0; index < BIG; index++)
        big[index] = (unsigned char)(index * 7919 >> 3);
    const struct talus_blob blobs[] = {{.name = "z last by name", .data = big, .bytes = BIG},
                                       {.name = "empty", .data = big, .bytes = 0},
                                       {.name = "a", .data = "\0\1\2", .bytes = 3}};
    scratch_path(path, *state, "checkpoint.h5");
    assert_int_equal(checkpoint_write(path, "{\"row\":7}", blobs, 1, &error), TALUS_OK);
    assert_int_equal(checkpoint_write(path, "{\"row\":8}", blobs, 3, &error), TALUS_OK);
    assert_int_equal(checkpoint_read(&checkpoint, path, &error), TALUS_OK);
    assert_string_equal(checkpoint.state, "{\"row\":8}");
    assert_int_equal(checkpoint.blob_count, 3);
    for (size_t index = 0; index < 3; index++) {
        assert_string_equal(checkpoint.blobs[index].name, blobs[index].name);
        assert_int_equal(checkpoint.blobs[index].bytes, blobs[index].bytes);
        assert_memory_equal(checkpoint.blobs[index].data, blobs[index].data, blobs[index].bytes);
    }
    checkpoint_release(&checkpoint);
    free(big);
}

/* However much of it is there, a damaged file is an error and never a crash. */
static void a_cut_file_is_refused(void **state)
{
    char path[SCRATCH_PATH_SIZE];
    const struct talus_blob blob = {.name = "a", .data = "abcdefgh", .bytes = 8};
    const long sizes[] = {3000, 2100, 1000, 500, 97, 8, 0};
    struct checkpoint checkpoint;
    struct talus_error error = {.status = TALUS_OK};
    scratch_path(path, *state, "checkpoint.h5");
    assert_int_equal(checkpoint_write(path, "{}", &blob, 1, &error), TALUS_OK);
    for (size_t index = 0; index < sizeof sizes / sizeof sizes[0]; index++) {
        error = (struct talus_error){.status = TALUS_OK};
        assert_int_equal(truncate(path, sizes[index]), 0);
        assert_int_equal(checkpoint_read(&checkpoint, path, &error), TALUS_IO);
        assert_true(strlen(error.text) > 0);
    }
    assert_int_equal(unlink(path), 0);
    error = (struct talus_error){.status = TALUS_OK};
    assert_int_equal(checkpoint_read(&checkpoint, path, &error), TALUS_IO);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, scratch_folder_make, scratch_folder_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(blobs_come_back_in_order),
        TEST(a_cut_file_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

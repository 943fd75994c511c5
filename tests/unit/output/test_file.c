/* SPDX-License-Identifier: Apache-2.0 */
#include "output/file.h"
#include "scratch_folder.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void replaces_a_file_at_once(void **state)
{
    char path[SCRATCH_PATH_SIZE], aside[FILE_PATH_SIZE];
    struct talus_error error = {.status = TALUS_OK};
    char *text = NULL;
    size_t length = 0;
    scratch_path(path, *state, "name.json");
    assert_int_equal(file_write_whole(path, "first", 5, &error), TALUS_OK);
    assert_int_equal(file_write_whole(path, "second one", 10, &error), TALUS_OK);
    assert_int_equal(file_read_whole(path, &text, &length, &error), TALUS_OK);
    assert_int_equal(length, 10);
    assert_string_equal(text, "second one");
    free(text);
    assert_int_equal(file_aside_path(aside, path, &error), TALUS_OK);
    assert_non_null(strstr(aside, "/.name.json.part"));
    assert_int_not_equal(access(aside, F_OK), 0);
}

static void keeps_the_old_file_when_the_new_one_fails(void **state)
{
    char path[SCRATCH_PATH_SIZE], aside[FILE_PATH_SIZE], text[32];
    struct talus_error error = {.status = TALUS_OK};
    scratch_path(path, *state, "kept");
    assert_int_equal(file_write_whole(path, "old", 3, &error), TALUS_OK);
    assert_int_equal(file_aside_path(aside, path, &error), TALUS_OK);
    /* Nothing was written aside: publishing fails. */
    assert_int_equal(file_publish(aside, path, &error), TALUS_IO);
    assert_int_equal(scratch_read(path, text, sizeof text), 3);
    assert_string_equal(text, "old");
}

static void says_which_limit_was_hit(void **state)
{
    static const struct {
        int number;
        enum talus_status status;
        const char *code;
    } cases[] = {{ENOSPC, TALUS_LIMIT, "disk_limit"},
                 {EDQUOT, TALUS_LIMIT, "disk_limit"},
                 {EFBIG, TALUS_LIMIT, "disk_limit"},
                 {ENOMEM, TALUS_MEMORY, "memory"},
                 {EACCES, TALUS_IO, "io"}};
    (void)state;
    for (size_t index = 0; index < sizeof cases / sizeof cases[0]; index++) {
        struct talus_error error = {.status = TALUS_OK};
        assert_int_equal(file_error(&error, cases[index].number, "write", "x"),
                         cases[index].status);
        assert_string_equal(error.code, cases[index].code);
    }
}

static void refuses_a_path_that_is_too_long(void **state)
{
    char name[FILE_PATH_SIZE + 10], path[FILE_PATH_SIZE];
    struct talus_error error = {.status = TALUS_OK};
    memset(name, 'a', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_int_equal(file_path(path, *state, name, &error), TALUS_IO);
}

static void makes_a_folder_and_its_parents(void **state)
{
    char path[SCRATCH_PATH_SIZE];
    struct stat information;
    struct talus_error error = {.status = TALUS_OK};
    scratch_path(path, *state, "one/two");
    assert_int_equal(file_make_folder(path, &error), TALUS_OK);
    assert_int_equal(file_make_folder(path, &error), TALUS_OK);
    assert_int_equal(stat(path, &information), 0);
    assert_true(S_ISDIR(information.st_mode));
    assert_int_equal(rmdir(path), 0);
    assert_int_equal(rmdir(scratch_path(path, *state, "one")), 0);
    scratch_append(scratch_path(path, *state, "file"), "text");
    assert_int_equal(file_make_folder(path, &error), TALUS_IO);
}

static void removes_what_was_left_aside(void **state)
{
    char path[SCRATCH_PATH_SIZE];
    struct talus_error error = {.status = TALUS_OK};
    scratch_append(scratch_path(path, *state, ".a.hdf.part"), "half");
    scratch_append(scratch_path(path, *state, "a.part"), "a user's file");
    scratch_append(scratch_path(path, *state, ".hidden"), "another");
    assert_int_equal(file_remove_asides(*state, &error), TALUS_OK);
    assert_int_not_equal(access(scratch_path(path, *state, ".a.hdf.part"), F_OK), 0);
    assert_int_equal(access(scratch_path(path, *state, "a.part"), F_OK), 0);
    assert_int_equal(access(scratch_path(path, *state, ".hidden"), F_OK), 0);
    assert_int_equal(file_remove_asides(scratch_path(path, *state, "nowhere"), &error), TALUS_OK);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, scratch_folder_make, scratch_folder_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(replaces_a_file_at_once),        TEST(keeps_the_old_file_when_the_new_one_fails),
        TEST(says_which_limit_was_hit),       TEST(refuses_a_path_that_is_too_long),
        TEST(makes_a_folder_and_its_parents), TEST(removes_what_was_left_aside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

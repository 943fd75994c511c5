/* SPDX-License-Identifier: Apache-2.0 */
/* What clients may read of a job's folder. */
#include "folder.h"
#include "server_fixture.h"
#include "text.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void test_public_names(void **state)
{
    static const char *const good[] = {"scene.json", "frames/frame_000000.hdf", "a b", "x.tmp.hdf"};
    static const char *const bad[] = {
        "",        "/etc/passwd",       "../x",  "a/../b", "a//b",     "a/",
        ".hidden", "a/.hidden",         "x.tmp", "x.part", "job.lock", "control.json",
        "a\nb",    "frames/x.hdf.part", "."};
    (void)state;
    for (size_t index = 0; index < sizeof good / sizeof good[0]; index++)
        assert_true(folder_name_public(good[index]));
    for (size_t index = 0; index < sizeof bad / sizeof bad[0]; index++)
        assert_false(folder_name_public(bad[index]));
}

static int try_open(const char *folder, const char *name)
{
    int descriptor = folder_open(folder, name);
    if (descriptor >= 0)
        assert_int_equal(close(descriptor), 0);
    return descriptor >= 0;
}

static void test_open_stays_inside(void **state)
{
    (void)state;
    char *folder = fixture_folder();
    char *link = folder_join(folder, "link"), *sub = folder_join(folder, "sub");
    char *up = folder_join(folder, "up");
    fixture_write(folder, "file", "x", 1, 0);
    assert_int_equal(symlink("/etc/passwd", link), 0);
    assert_int_equal(symlink("/etc", up), 0);
    assert_int_equal(mkdir(sub, 0700), 0);
    fixture_write(folder, "sub/file", "x", 1, 0);
    assert_true(try_open(folder, "file"));
    assert_true(try_open(folder, "sub/file"));
    assert_false(try_open(folder, "link"));
    assert_false(try_open(folder, "up/passwd"));
    assert_false(try_open(folder, "sub"));
    assert_false(try_open(folder, "../../etc/passwd"));
    assert_false(try_open(folder, "/etc/passwd"));
    assert_false(try_open(folder, "none"));
    free(link);
    free(sub);
    free(up);
    fixture_folder_remove(folder);
}

static bool name_note(const char *name, void *context)
{
    text_print(context, "%s;", name);
    return true;
}

static void test_list_and_size(void **state)
{
    (void)state;
    struct text names = {0};
    char *folder = fixture_folder(), *sub = folder_join(folder, "frames");
    char *hidden = folder_join(folder, ".pictures");
    assert_int_equal(mkdir(sub, 0700), 0);
    assert_int_equal(mkdir(hidden, 0700), 0);
    fixture_write(folder, "frames/a.hdf", "12345", 5, 0);
    fixture_write(folder, "frames/b.hdf.part", "1", 1, 0);
    fixture_write(folder, ".pictures/a.png", "1", 1, 0);
    fixture_write(folder, "job.lock", "", 0, 0);
    folder_list(folder, name_note, &names);
    assert_string_equal(names.data, "frames/a.hdf;");
    text_release(&names);
    assert_int_equal(folder_size(folder), 7);
    free(sub);
    free(hidden);
    fixture_folder_remove(folder);
    assert_int_equal(folder_size("/nonexistent/folder"), 0);
}

static void test_written_once(void **state)
{
    struct talus_error error = {0};
    (void)state;
    char *folder = fixture_folder();
    assert_int_equal(folder_write(folder, "a", "1", 1, &error), TALUS_OK);
    assert_int_equal(folder_write(folder, "a", "2", 1, &error), TALUS_IO);
    fixture_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_public_names),
        cmocka_unit_test(test_open_stays_inside),
        cmocka_unit_test(test_list_and_size),
        cmocka_unit_test(test_written_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

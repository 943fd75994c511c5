/* SPDX-License-Identifier: Apache-2.0 */
/* Every example scene is valid, and reading its effective form changes nothing. */
#include "scene/scene_json.h"

#include <glob.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static void print_issues(const char *path, const struct scene_issues *issues)
{
    for (size_t index = 0; index < issues->count; index++)
        (void)fprintf(stderr, "%s: %s: %s\n", path, issues->items[index].pointer,
                      issues->items[index].detail);
}

static void check_example(const char *path)
{
    struct talus_scene scene, again;
    struct scene_issues issues, warnings, more_issues, more_warnings;
    json_t *effective, *twice;
    enum talus_status status = scene_read_file(path, &scene, &effective, &issues, &warnings);
    print_issues(path, &issues);
    assert_int_equal(status, TALUS_OK);
    assert_int_equal(scene_read(effective, &again, &twice, &more_issues, &more_warnings), TALUS_OK);
    assert_true(json_equal(effective, twice));
    json_decref(effective);
    json_decref(twice);
    scene_issues_release(&issues);
    scene_issues_release(&warnings);
    scene_issues_release(&more_issues);
    scene_issues_release(&more_warnings);
    talus_scene_release(&scene);
    talus_scene_release(&again);
}

static void examples_are_valid(void **state)
{
    (void)state;
    glob_t files;
    assert_int_equal(glob(TALUS_SCENES "/*.json", 0, NULL, &files), 0);
    assert_true(files.gl_pathc > 0);
    for (size_t index = 0; index < files.gl_pathc; index++)
        check_example(files.gl_pathv[index]);
    globfree(&files);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_are_valid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

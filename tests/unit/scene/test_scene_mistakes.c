/* SPDX-License-Identifier: Apache-2.0 */
/* How mistakes are reported; what they are is in test_mistakes_SECTION.c. */
#include "scene_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void bases_are_valid(void **state)
{
    (void)state;
    for (int base = BASE_PLANE; base <= BASE_FLUID; base++) {
        struct fixture_result result;
        json_t *scene = fixture_scene((enum fixture_base)base);
        fixture_read(scene, &result);
        for (size_t index = 0; index < result.issues.count; index++)
            (void)fprintf(stderr, "%s: %s\n", result.issues.items[index].pointer,
                          result.issues.items[index].detail);
        assert_int_equal(result.status, TALUS_OK);
        assert_int_equal(result.warnings.count, 0);
        fixture_result_release(&result);
        json_decref(scene);
    }
}

static void all_mistakes_are_reported_at_once(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/grid/cel", "1");
    fixture_change(scene, "/solver/shape", "\"linera\"");
    fixture_change(scene, "/materials/soil/density", "-1");
    fixture_change(scene, "/bodies/0/velocity", "[1]");
    fixture_change(scene, "/boundaries/1/box/max", "[0, 0]");
    fixture_change(scene, "/probes/1/component", "\"w\"");
    fixture_change(scene, "/output", "{\"frame\": {}}");
    fixture_read(scene, &result);
    assert_int_equal(result.issues.count, 8); /* the box is wrong on two axes */
    assert_non_null(fixture_find(&result.issues, "/output/frame", "unknown_key"));
    assert_non_null(fixture_find(&result.issues, "/grid/cel", "unknown_key"));
    fixture_result_release(&result);
    json_decref(scene);
}

static void there_are_fifty_at_most(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    for (int index = 0; index < 80; index++) {
        char pointer[32];
        (void)snprintf(pointer, sizeof pointer, "/solver/x%d", index);
        fixture_change(scene, pointer, "1");
    }
    fixture_read(scene, &result);
    assert_int_equal(result.issues.count, SCENE_ISSUE_MAX);
    fixture_result_release(&result);
    json_decref(scene);
}

static void near_misses_are_suggested(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/bodies/0/particels_per_cell", "[2, 2]");
    fixture_change(scene, "/solver/anti_locking/control", "\"cel\"");
    fixture_read(scene, &result);
    const struct scene_issue *key =
        fixture_find(&result.issues, "/bodies/0/particels_per_cell", "unknown_key");
    const struct scene_issue *word =
        fixture_find(&result.issues, "/solver/anti_locking/control", "unknown_value");
    assert_non_null(key);
    assert_non_null(strstr(key->detail, "'particles_per_cell'"));
    assert_non_null(word);
    assert_non_null(strstr(word->detail, "\"cell\""));
    assert_string_equal(json_string_value(word->given), "cel");
    assert_int_equal(json_array_size(word->allowed), 4);
    fixture_result_release(&result);
    json_decref(scene);
}

/* With its shape a key is no mistake; nor is its default with any other. */
static void keys_of_a_shape_belong_to_it(void **state)
{
    (void)state;
    static const char *const solvers[] = {
        "{\"shape\": \"cpdi_hybrid\", \"cpdi_hybrid\": {\"count\": 4, \"scale\": 0.5}}",
        "{\"shape\": \"gimp_scaled\", \"gimp_scaling\": \"stretch\"}",
        "{\"cpdi_hybrid\": {\"count\": 8, \"scale\": 0.75}, \"gimp_scaling\": \"volume\"}",
    };
    for (size_t index = 0; index < sizeof solvers / sizeof solvers[0]; index++) {
        struct fixture_result result;
        json_t *scene = fixture_scene(BASE_PLANE);
        fixture_change(scene, "/solver", solvers[index]);
        fixture_read(scene, &result);
        assert_int_equal(result.status, TALUS_OK);
        fixture_result_release(&result);
        json_decref(scene);
    }
}

static void depth_is_limited(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE), *inner = json_array();
    for (int depth = 0; depth < 1000; depth++)
        inner = json_pack("[o]", inner);
    assert_int_equal(json_object_set_new(scene, "title", inner), 0);
    fixture_read(scene, &result);
    assert_non_null(fixture_find(&result.issues, "", "depth"));
    fixture_result_release(&result);
    json_decref(scene);
}

static void pointers_escape_their_keys(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    assert_int_equal(json_object_set_new(scene, "a/b~c", json_null()), 0);
    fixture_read(scene, &result);
    assert_non_null(fixture_find(&result.issues, "/a~1b~0c", "unknown_key"));
    fixture_result_release(&result);
    json_decref(scene);
}

static void issues_become_json(void **state)
{
    (void)state;
    struct fixture_result result;
    json_t *scene = fixture_scene(BASE_PLANE);
    fixture_change(scene, "/duration", "-1");
    fixture_read(scene, &result);
    json_t *list = scene_issues_json(&result.issues);
    json_t *issue = json_array_get(list, 0);
    assert_int_equal(json_array_size(list), 1);
    assert_string_equal(json_string_value(json_object_get(issue, "pointer")), "/duration");
    assert_string_equal(json_string_value(json_object_get(issue, "code")), "range");
    assert_true(json_number_value(json_object_get(issue, "given")) == -1.0);
    assert_true(json_number_value(json_object_get(json_object_get(issue, "allowed"), "above")) ==
                0.0);
    json_decref(list);
    fixture_result_release(&result);
    json_decref(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bases_are_valid),
        cmocka_unit_test(all_mistakes_are_reported_at_once),
        cmocka_unit_test(there_are_fifty_at_most),
        cmocka_unit_test(near_misses_are_suggested),
        cmocka_unit_test(keys_of_a_shape_belong_to_it),
        cmocka_unit_test(depth_is_limited),
        cmocka_unit_test(pointers_escape_their_keys),
        cmocka_unit_test(issues_become_json),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Study designs of any kind: mistakes in them, and limits. */
#include "study_design_fixture.h"

#include <stdio.h>
#include <time.h>

static void test_design_mistakes(void **state)
{
    (void)state;
    design_expect("[]", "/design", "type", "object");
    design_expect("{}", "/design", "required", "'bisect'");
    design_expect("{\"grid\":5}", "/design/grid", "type", "object");
    design_expect("{\"list\":{\"rows\":[{\"/duration\":1}]},\"grid\":{}}", "/design",
                  "contradiction", "");
    design_expect("{\"list\":{\"rows\":[{\"/duration\":1}]},\"gird\":{}}", "/design/gird",
                  "unknown_key", "\"grid\"");
}

/* 10^12 combinations cost what their text costs: no row is made. */
static void test_too_many(void **state)
{
    struct study_plan plan;
    json_t *parameters = json_object(), *values = json_array(), *scene = design_parse(design_scene);
    (void)state;
    for (int value = 0; value < 100; value++)
        assert_int_equal(json_array_append_new(values, json_integer(value)), 0);
    for (int name = 0; name < 6; name++) {
        char text[8];
        (void)snprintf(text, sizeof text, "/new%d", name);
        assert_int_equal(json_object_set(parameters, text, values), 0);
    }
    json_t *design = json_pack("{s:{s:o}}", "grid", "parameters", parameters);
    json_t *errors = json_array();
    clock_t begin = clock();
    assert_false(study_plan_read(scene, design, 10000, &plan, errors));
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 0.5); /* 1e12 rows: days */
    const json_t *issue = json_array_get(errors, 0);
    assert_int_equal(json_array_size(errors), 1);
    assert_string_equal(json_string_value(json_object_get(issue, "code")), "range");
    assert_true(json_number_value(json_object_get(issue, "given")) == 1e12);
    assert_true(json_number_value(json_object_get(json_object_get(issue, "allowed"), "maximum")) ==
                10000.0);
    json_decref(errors);
    json_decref(design);
    json_decref(values);
    json_decref(scene);
}

/* More names or places than a study may have. */
static void test_too_wide(void **state)
{
    (void)state;
    for (int wide = 0; wide < 2; wide++) {
        struct study_plan plan;
        json_t *parameters = json_object(), *set = json_object(),
               *scene = design_parse(design_scene);
        json_t *errors = json_array();
        for (int index = 0; index < (wide == 0 ? 65 : 257); index++) {
            char text[16];
            (void)snprintf(text, sizeof text, "/new%d", index);
            (void)json_object_set_new(wide == 0 ? parameters : set, text,
                                      wide == 0 ? json_pack("[i]", 1) : json_string("a"));
        }
        if (wide == 1)
            (void)json_object_set_new(parameters, "a", json_pack("[i]", 1));
        json_t *design = json_pack("{s:{s:o, s:o}}", "grid", "parameters", parameters, "set", set);
        assert_false(study_plan_read(scene, design, 10000, &plan, errors));
        const json_t *issue = json_array_get(errors, 0);
        assert_string_equal(json_string_value(json_object_get(issue, "code")), "range");
        json_decref(errors);
        json_decref(design);
        json_decref(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_design_mistakes),
        cmocka_unit_test(test_too_many),
        cmocka_unit_test(test_too_wide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

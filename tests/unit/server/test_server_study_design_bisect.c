/* SPDX-License-Identifier: Apache-2.0 */
/* Designs of the kind bisect. */
#include "study_design_fixture.h"

static void test_bisect(void **state)
{
    struct study_plan plan =
        design_plan("{\"bisect\":{\"parameter\":\"/solver/courant\",\"low\":0.1,\"high\":2,"
                    "\"tolerance\":0.01,\"condition\":\"energy_error < 0.01 && n >= 2\"}}");
    (void)state;
    assert_int_equal(plan.kind, STUDY_BISECT);
    assert_string_equal(plan.bisect.parameter, "/solver/courant");
    assert_int_equal(plan.bisect.condition.term_count, 2);
    assert_int_equal(json_array_size(plan.rows), 1);
    assert_int_equal(study_plan_count(&plan), 10); /* 1.9 / 2^8 is below 0.01 */
    json_t *row = study_bisect_row(&plan, json_array_get(plan.rows, 0), 0.5);
    design_expect_json(
        row, "{\"parameters\":{\"/solver/courant\":0.5},\"set\":{\"/solver/courant\":0.5}}");
    json_decref(row);
    study_plan_release(&plan);
    plan = design_plan("{\"bisect\":{\"parameter\":\"/solver/time_step\",\"low\":0.1,\"high\":2,"
                       "\"tolerance\":5,\"condition\":\"n>1\"}}");
    assert_int_equal(study_plan_count(&plan), 2);
    study_plan_release(&plan);
}

static void test_bisect_for_each(void **state)
{
    struct study_plan plan =
        design_plan("{\"bisect\":{\"parameter\":\"/solver/courant\",\"low\":0.1,\"high\":2,"
                    "\"tolerance\":0.01,\"condition\":\"n<1\",\"for_each\":{\"parameters\":{"
                    "\"/duration\":[1,2,3]},\"set\":{}}}}");
    (void)state;
    assert_int_equal(json_array_size(plan.rows), 3);
    assert_int_equal(study_plan_count(&plan), 30);
    json_t *row = study_bisect_row(&plan, json_array_get(plan.rows, 1), 0.5);
    design_expect_json(row, "{\"parameters\":{\"/duration\":2,\"/solver/courant\":0.5},"
                            "\"set\":{\"/duration\":2,\"/solver/courant\":0.5}}");
    /* The rows of the plan are as they were. */
    assert_int_equal(json_object_size(json_object_get(json_array_get(plan.rows, 1), "parameters")),
                     1);
    json_decref(row);
    study_plan_release(&plan);
    design_expect("{\"bisect\":{\"parameter\":\"/duration\",\"low\":0.1,\"high\":2,"
                  "\"tolerance\":0.01,\"condition\":\"n<1\",\"for_each\":{\"parameters\":{"
                  "\"/duration\":[1,2,3]}}}}",
                  "/design/bisect/parameter", "contradiction", "for_each");
    design_expect("{\"bisect\":{\"parameter\":\"/duration\",\"low\":0.1,\"high\":2,"
                  "\"tolerance\":0.01,\"condition\":\"n<1\",\"for_each\":[]}}",
                  "/design/bisect/for_each", "type", "object");
}

static void test_bisect_mistakes(void **state)
{
    (void)state;
    design_expect(BISECT("\"/grid\"", "0", "1", "0.1", "\"n<1\""), "/design/bisect/parameter",
                  "type", "number");
    design_expect(BISECT("\"/bodies/0/name\"", "0", "1", "0.1", "\"n<1\""),
                  "/design/bisect/parameter", "type", "number");
    design_expect(BISECT("\"courant\"", "0", "1", "0.1", "\"n<1\""), "/design/bisect/parameter",
                  "pointer", "/ before");
    design_expect(BISECT("\"/sovler/courant\"", "0", "1", "0.1", "\"n<1\""),
                  "/design/bisect/parameter", "pointer", "'/sovler'");
    design_expect(BISECT("5", "0", "1", "0.1", "\"n<1\""), "/design/bisect/parameter", "type",
                  "text");
    design_expect(BISECT("\"/duration\"", "1", "1", "0.1", "\"n<1\""), "/design/bisect/high",
                  "range", "larger");
    design_expect(BISECT("\"/duration\"", "\"1\"", "1", "0.1", "\"n<1\""), "/design/bisect/low",
                  "type", "number");
    design_expect(BISECT("\"/duration\"", "0", "1", "0", "\"n<1\""), "/design/bisect/tolerance",
                  "range", "positive");
    design_expect(BISECT("\"/duration\"", "1", "2", "1e-14", "\"n<1\""), "/design/bisect/tolerance",
                  "range", "1e-12");
    design_expect(BISECT("\"/duration\"", "0", "1e300", "1", "\"n<1\""), "/design/bisect/tolerance",
                  "range", "");
    design_expect(BISECT("\"/duration\"", "0", "1", "0.1", "\"n=1\""), "/design/bisect/condition",
                  "syntax", "at character 2");
    design_expect(
        "{\"bisect\":{\"parameter\":\"/duration\",\"low\":0,\"high\":1,\"tolerance\":0.1}}",
        "/design/bisect/condition", "required", "");
    design_expect("{\"bisect\":{\"parameter\":\"/duration\",\"low\":0,\"high\":1,\"tolerance\":0.1,"
                  "\"condition\":\"n<1\",\"conditoin\":1}}",
                  "/design/bisect/conditoin", "unknown_key", "\"condition\"");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bisect),
        cmocka_unit_test(test_bisect_for_each),
        cmocka_unit_test(test_bisect_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Designs of the kind work_precision. */
#include "study_design_fixture.h"

static void test_work_precision(void **state)
{
    struct study_plan plan = design_plan(
        "{\"work_precision\":{\"variants\":[{\"label\":\"linear\",\"set\":{\"/solver/shape\":"
        "\"linear\"}},{\"label\":\"own\",\"set\":{\"/solver\":{\"shape\":\"gimp\"}}}],"
        "\"resolutions\":[{\"label\":\"coarse\",\"set\":{}},{\"label\":\"fine\",\"set\":{"
        "\"/grid/cell\":0.05,\"/solver/time_step\":0.001}}],\"error\":\"error.tip\","
        "\"cost\":\"particle_steps\"}}");
    (void)state;
    assert_int_equal(plan.kind, STUDY_WORK_PRECISION);
    assert_string_equal(plan.error_metric, "error.tip");
    assert_string_equal(plan.cost_metric, "particle_steps");
    design_expect_json(plan.names, "[\"variant\",\"resolution\"]");
    assert_int_equal(study_plan_count(&plan), 4);
    design_expect_json(
        json_array_get(plan.rows, 3),
        "{\"parameters\":{\"variant\":\"own\",\"resolution\":\"fine\"},\"set\":{"
        "\"/grid/cell\":0.05,\"/solver\":{\"shape\":\"gimp\"},\"/solver/time_step\":0.001}"
        "}");
    study_plan_release(&plan);
    plan = design_plan("{\"work_precision\":{\"variants\":[{\"label\":\"a\",\"set\":{}}],"
                       "\"resolutions\":[{\"label\":\"b\",\"set\":{}}],\"error\":\"error.tip\"}}");
    assert_string_equal(plan.cost_metric, "wall_seconds");
    study_plan_release(&plan);
}

static void test_work_precision_mistakes(void **state)
{
    (void)state;
    design_expect(COMPARE(ONE, OTHER, ""), "/design/work_precision/error", "required", "");
    design_expect(COMPARE(ONE, OTHER, ",\"error\":5"), "/design/work_precision/error", "type", "");
    design_expect(COMPARE(ONE, OTHER, TIP ",\"cost\":\"money\""), "/design/work_precision/cost",
                  "unknown_value", "'wall_seconds'");
    design_expect(COMPARE(ONE, OTHER, TIP ",\"costs\":1"), "/design/work_precision/costs",
                  "unknown_key", "\"cost\"");
    design_expect(COMPARE("[]", OTHER, TIP), "/design/work_precision/variants", "range", "one");
    design_expect(COMPARE("[5]", OTHER, TIP), "/design/work_precision/variants/0", "type",
                  "object");
    design_expect(COMPARE("[{\"set\":{}}]", OTHER, TIP), "/design/work_precision/variants/0/label",
                  "required", "");
    design_expect(COMPARE(ONE, "[{\"label\":\"b\"}]", TIP),
                  "/design/work_precision/resolutions/0/set", "required", "");
    design_expect(COMPARE(ONE, "[{\"label\":\"b\",\"set\":{},\"sets\":1}]", TIP),
                  "/design/work_precision/resolutions/0/sets", "unknown_key", "\"set\"");
    design_expect(COMPARE(ONE, "[{\"label\":\"b\",\"set\":{}},{\"label\":\"b\",\"set\":{}}]", TIP),
                  "/design/work_precision/resolutions/1/label", "duplicate", "");
    design_expect(COMPARE(ONE, ONE, TIP), "/design/work_precision/resolutions/0/set/~1duration",
                  "contradiction", "variant 'a'");
    design_expect(COMPARE("[{\"label\":\"a\",\"set\":{\"/gird/cell\":1}}]", OTHER, TIP),
                  "/design/work_precision/variants/0/set/~1gird~1cell", "pointer", "'/gird'");
    design_expect(COMPARE(ONE, "[{\"label\":\"b\",\"set\":{\"cell\":1}}]", TIP),
                  "/design/work_precision/resolutions/0/set/cell", "pointer", "/ before");
    design_expect(COMPARE("[{\"label\":\"a\",\"set\":{\"/grid\":7}}]", OTHER, TIP),
                  "/design/work_precision/resolutions/0/set/~1grid~1cell", "pointer", "'/grid'");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_work_precision),
        cmocka_unit_test(test_work_precision_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

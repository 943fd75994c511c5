/* SPDX-License-Identifier: Apache-2.0 */
/* Designs of the kind list. */
#include "study_design_fixture.h"

static void test_list(void **state)
{
    struct study_plan plan =
        design_plan("{\"list\":{\"rows\":[{\"a\":1,\"/duration\":2},{\"/duration\":3,\"a\":4}],"
                    "\"set\":{\"/grid/cell\":\"a/10\"}}}");
    (void)state;
    assert_int_equal(plan.kind, STUDY_LIST);
    design_expect_json(plan.rows,
                       "[{\"parameters\":{\"a\":1,\"/duration\":2},\"set\":{\"/duration\":2,"
                       "\"/grid/cell\":0.1}},{\"parameters\":{\"a\":4,\"/duration\":3},"
                       "\"set\":{\"/duration\":3,\"/grid/cell\":0.4}}]");
    study_plan_release(&plan);
}

static void test_list_mistakes(void **state)
{
    (void)state;
    design_expect("{\"list\":{}}", "/design/list/rows", "required", "");
    design_expect("{\"list\":{\"rows\":[]}}", "/design/list/rows", "range", "one");
    design_expect("{\"list\":{\"rows\":[5]}}", "/design/list/rows/0", "type", "object");
    design_expect("{\"list\":{\"rows\":[{}]}}", "/design/list/rows/0", "range", "one");
    design_expect("{\"list\":{\"rows\":[{\"/duration\":1},{\"/duration\":1},{}]}}",
                  "/design/list/rows/2/~1duration", "required", "first row");
    design_expect("{\"list\":{\"rows\":[{\"/duration\":1},{\"/duration\":1,\"/duratoin\":2}]}}",
                  "/design/list/rows/1/~1duratoin", "unknown_key", "/duration");
    design_expect("{\"list\":{\"rows\":[{\"/duration\":1},{\"/duration\":null}]}}",
                  "/design/list/rows/1/~1duration", "type", "number");
    design_expect("{\"list\":{\"rows\":[{\"a\":1}]}}", "/design/list/rows/0/a", "unused", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_list),
        cmocka_unit_test(test_list_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

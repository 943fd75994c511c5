/* SPDX-License-Identifier: Apache-2.0 */
/* Designs of the kind grid, and the places that `set` names. */
#include "study_design_fixture.h"

static void test_grid(void **state)
{
    struct study_plan plan = design_plan(
        "{\"grid\":{\"parameters\":{\"aspect\":[0.5,3],\"/duration\":[1,2],\"model\":[\"j2\",{"
        "\"label\":\"soft\",\"value\":{\"model\":\"tresca\"}}],\"n\":[4]},\"set\":{"
        "\"/bodies/0/box/max/1\":\"0.1 * aspect\",\"/materials/sand/model\":\"model\","
        "\"/materials/sand/a~1b\":\"aspect\",\"/solver/new\":\"n^2\",\"/grid/max/-\":7}}}");
    (void)state;
    assert_int_equal(plan.kind, STUDY_GRID);
    assert_int_equal(study_plan_count(&plan), 8);
    design_expect_json(plan.names, "[\"aspect\",\"/duration\",\"model\",\"n\"]");
    design_expect_json(
        json_array_get(plan.rows, 0),
        "{\"parameters\":{\"aspect\":0.5,\"/duration\":1,\"model\":\"j2\",\"n\":4},"
        "\"set\":{\"/bodies/0/box/max/1\":0.05,\"/duration\":1,\"/grid/max/-\":7,"
        "\"/materials/sand/a~1b\":0.5,\"/materials/sand/model\":\"j2\",\"/solver/new\":16}"
        "}");
    /* The last parameter changes fastest; 3 * 0.1 is 0.3, and n^2 a whole number. */
    design_expect_json(
        json_array_get(plan.rows, 7),
        "{\"parameters\":{\"aspect\":3,\"/duration\":2,\"model\":\"soft\",\"n\":4},"
        "\"set\":{\"/bodies/0/box/max/1\":0.3,\"/duration\":2,\"/grid/max/-\":7,"
        "\"/materials/sand/a~1b\":3,\"/materials/sand/model\":{\"model\":\"tresca\"},"
        "\"/solver/new\":16}}");
    json_t *scene = design_parse(design_scene), *before = design_parse(design_scene);
    json_t *changed = study_scene(scene, json_object_get(json_array_get(plan.rows, 7), "set"));
    design_expect_json(
        changed,
        "{\"duration\":2,\"grid\":{\"cell\":0.1,\"max\":[1,2,7]},\"solver\":{\"time_step\":"
        "\"auto\",\"new\":16},\"materials\":{\"sand\":{\"model\":{\"model\":\"tresca\"},"
        "\"a/b\":3}},\"bodies\":[{\"name\":\"column\",\"box\":{\"max\":[1,0.3]}}]}");
    assert_true(json_equal(scene, before));
    json_decref(changed);
    json_decref(scene);
    json_decref(before);
    study_plan_release(&plan);
}

/* A place within another that the same row sets: the outer one first, whatever the order. */
static void test_nested_places(void **state)
{
    struct study_plan plan =
        design_plan("{\"grid\":{\"parameters\":{\"a\":[1,2],\"m\":[{\"label\":\"x\",\"value\":{"
                    "\"friction\":{}}}]},\"set\":{\"/materials/clay/friction/a0\":\"a\","
                    "\"/materials/clay\":\"m\",\"/materials/clay-2\":\"a\"}}}");
    json_t *scene = design_parse(design_scene);
    (void)state;
    json_t *changed = study_scene(scene, json_object_get(json_array_get(plan.rows, 1), "set"));
    design_expect_json(json_object_get(json_object_get(changed, "materials"), "clay"),
                       "{\"friction\":{\"a0\":2}}");
    json_decref(changed);
    json_decref(scene);
    study_plan_release(&plan);
    design_expect("{\"grid\":{\"parameters\":{\"a\":[1],\"m\":[{\"label\":\"x\",\"value\":{}}]},"
                  "\"set\":{\"/materials/clay/friction/a0\":\"a\",\"/materials/clay\":\"m\"}}}",
                  "/design/grid/set/~1materials~1clay~1friction~1a0", "pointer",
                  "'/materials/clay/friction'");
}

static void test_grid_mistakes(void **state)
{
    (void)state;
    design_expect("{\"grid\":{}}", "/design/grid/parameters", "required", "");
    design_expect(GRID("[]", "{}"), "/design/grid/parameters", "type", "object");
    design_expect(GRID("{}", "{}"), "/design/grid/parameters", "range", "one parameter");
    design_expect("{\"grid\":{\"parameters\":{\"/duration\":[1]},\"sett\":{}}}",
                  "/design/grid/sett", "unknown_key", "\"set\"");
    design_expect(GRID("{\"/duration\":1}", "{}"), "/design/grid/parameters/~1duration", "type",
                  "array");
    design_expect(GRID("{\"/duration\":[]}", "{}"), "/design/grid/parameters/~1duration", "range",
                  "one");
    design_expect(GRID("{\"/duration\":[1,true]}", "{}"), "/design/grid/parameters/~1duration/1",
                  "type", "label");
    design_expect(GRID("{\"/duration\":[{\"value\":1}]}", "{}"),
                  "/design/grid/parameters/~1duration/0/label", "required", "");
    design_expect(GRID("{\"/duration\":[{\"label\":\"a\"}]}", "{}"),
                  "/design/grid/parameters/~1duration/0/value", "required", "");
    design_expect(GRID("{\"/duration\":[{\"label\":\"a\",\"valeu\":1,\"value\":1}]}", "{}"),
                  "/design/grid/parameters/~1duration/0/valeu", "unknown_key", "\"value\"");
    design_expect(GRID("{\"/duration\":[{\"label\":\"\",\"value\":1}]}", "{}"),
                  "/design/grid/parameters/~1duration/0/label", "range", "");
    design_expect(GRID("{\"/duration\":[{\"label\":7,\"value\":1}]}", "{}"),
                  "/design/grid/parameters/~1duration/0/label", "type", "");
    design_expect(GRID("{\"/duration\":[1,2,1]}", "{}"), "/design/grid/parameters/~1duration/2",
                  "duplicate", "");
    design_expect(GRID("{\"/duration\":[\"a\",{\"label\":\"a\",\"value\":2}]}", "{}"),
                  "/design/grid/parameters/~1duration/1", "duplicate", "");
    design_expect(GRID("{\"a\":[1]}", "{}"), "/design/grid/parameters/a", "unused", "'a'");
    design_expect(GRID("{\"a\":[1]}", "[]"), "/design/grid/set", "type", "object");
    design_expect(GRID("{\"a b\":[1],\"/duration\":[1]}", "{\"/grid/cell\":\"a b\"}"),
                  "/design/grid/parameters/a b", "name", "letters");
    design_expect(GRID("{\"sin\":[1]}", "{\"/grid/cell\":\"sin\"}"), "/design/grid/parameters/sin",
                  "name", "function");
}

static void test_set_mistakes(void **state)
{
    (void)state;
    design_expect(GRID("{\"a\":[1]}", "{\"/duration\":\"a\",\"/grid/cell\":\"heigth + a\"}"),
                  "/design/grid/set/~1grid~1cell", "unknown_name",
                  "at character 1: unknown name heigth");
    design_expect(
        GRID("{\"height\":[1]}", "{\"/duration\":\"height\",\"/grid/cell\":\"2 * heigth\"}"),
        "/design/grid/set/~1grid~1cell", "unknown_name", "did you mean 'height'?");
    design_expect(GRID("{\"a\":[1]}", "{\"/duration\":\"a\",\"/grid/cell\":\"2 * (a\"}"),
                  "/design/grid/set/~1grid~1cell", "syntax", "at character 7: a ) is wanted");
    design_expect(GRID("{\"a\":[1]}", "{\"/duration\":\"a\",\"/grid/cell\":true}"),
                  "/design/grid/set/~1grid~1cell", "type", "expression");
    design_expect(GRID("{\"a\":[2,1,0,0.5]}", "{\"/duration\":\"1 / (a - 1)\"}"),
                  "/design/grid/set/~1duration", "not_finite",
                  "row 1 {\"a\":1}: a division by zero, at character 3");
    design_expect(GRID("{\"a\":[1,\"x\"]}", "{\"/duration\":\"a + 1\"}"),
                  "/design/grid/set/~1duration", "type",
                  "row 1 {\"a\":\"x\"}: 'a' is not a number");
    design_expect(GRID("{\"a\":[1]}", "{\"duration\":\"a\"}"), "/design/grid/set/duration",
                  "pointer", "/ before each key");
    design_expect(GRID("{\"a\":[1]}", "{\"\":\"a\"}"), "/design/grid/set/", "pointer", "/ before");
    design_expect(GRID("{\"a\":[1]}", "{\"/du~ration\":\"a\"}"), "/design/grid/set/~1du~0ration",
                  "pointer", "~0 for");
    design_expect(GRID("{\"a\":[1]}", "{\"/gird/cell\":\"a\"}"), "/design/grid/set/~1gird~1cell",
                  "pointer", "no object or array at '/gird'");
    design_expect(GRID("{\"a\":[1]}", "{\"/grid/cell/x\":\"a\"}"),
                  "/design/grid/set/~1grid~1cell~1x", "pointer", "'/grid/cell'");
    design_expect(GRID("{\"a\":[1]}", "{\"/bodies/7/name\":\"a\"}"),
                  "/design/grid/set/~1bodies~17~1name", "pointer", "'/bodies/7' is not an index");
    design_expect(GRID("{\"a\":[1]}", "{\"/grid/max/x\":\"a\"}"), "/design/grid/set/~1grid~1max~1x",
                  "pointer", "index");
    design_expect(GRID("{\"/gird/cell\":[1]}", "{}"), "/design/grid/parameters/~1gird~1cell",
                  "pointer", "no object");
    design_expect(GRID("{\"a\":[1],\"/duration\":[1]}", "{\"/duration\":\"a\"}"),
                  "/design/grid/set/~1duration", "contradiction", "same place");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_grid),
        cmocka_unit_test(test_nested_places),
        cmocka_unit_test(test_grid_mistakes),
        cmocka_unit_test(test_set_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

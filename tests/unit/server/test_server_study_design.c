/* SPDX-License-Identifier: Apache-2.0 */
/* Study designs: what they expand to, each mistake with its pointer and code, and limits. */
#include "server_fixture.h"
#include "study_design.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char scene_text[] =
    "{\"duration\":1,\"grid\":{\"cell\":0.1,\"max\":[1,2]},\"solver\":{\"time_step\":\"auto\"},"
    "\"materials\":{\"sand\":{\"model\":\"matsuoka_nakai\",\"a/b\":1}},"
    "\"bodies\":[{\"name\":\"column\",\"box\":{\"max\":[1,1]}}]}";

static json_t *parse(const char *text)
{
    json_error_t error;
    json_t *value = json_loads(text, JSON_DECODE_ANY, &error);
    if (value == NULL)
        fail_msg("%s: %s", error.text, text);
    return value;
}

static struct study_plan plan_good(const char *text)
{
    struct study_plan plan;
    json_t *scene = parse(scene_text), *design = parse(text), *errors = json_array();
    if (!study_plan_read(scene, design, 10000, &plan, errors))
        fail_msg("%s: %s", text, json_dumps(errors, 0));
    assert_int_equal(json_array_size(errors), 0);
    json_decref(errors);
    json_decref(design);
    json_decref(scene);
    return plan;
}

/* One mistake, with this pointer and code, and a part of its text. */
static void expect(const char *text, const char *pointer, const char *code, const char *part)
{
    struct study_plan plan;
    json_t *scene = parse(scene_text), *design = parse(text), *errors = json_array();
    assert_false(study_plan_read(scene, design, 100, &plan, errors));
    assert_null(plan.rows);
    const json_t *first = json_array_get(errors, 0);
    if (json_array_size(errors) != 1 ||
        strcmp(json_string_value(json_object_get(first, "pointer")), pointer) != 0 ||
        strcmp(json_string_value(json_object_get(first, "code")), code) != 0 ||
        strstr(json_string_value(json_object_get(first, "detail")), part) == NULL)
        fail_msg("%s\n%s %s %s\n%s", text, pointer, code, part, json_dumps(errors, JSON_INDENT(1)));
    json_decref(errors);
    json_decref(design);
    json_decref(scene);
}

static void expect_json(const json_t *value, const char *text)
{
    json_t *expected = parse(text);
    if (!json_equal(value, expected))
        fail_msg("%s\nis not\n%s", json_dumps(value, JSON_ENCODE_ANY), text);
    json_decref(expected);
}

static void test_grid(void **state)
{
    struct study_plan plan = plan_good(
        "{\"grid\":{\"parameters\":{\"aspect\":[0.5,3],\"/duration\":[1,2],\"model\":[\"j2\",{"
        "\"label\":\"soft\",\"value\":{\"model\":\"tresca\"}}],\"n\":[4]},\"set\":{"
        "\"/bodies/0/box/max/1\":\"0.1 * aspect\",\"/materials/sand/model\":\"model\","
        "\"/materials/sand/a~1b\":\"aspect\",\"/solver/new\":\"n^2\",\"/grid/max/-\":7}}}");
    (void)state;
    assert_int_equal(plan.kind, STUDY_GRID);
    assert_int_equal(study_plan_count(&plan), 8);
    expect_json(plan.names, "[\"aspect\",\"/duration\",\"model\",\"n\"]");
    expect_json(json_array_get(plan.rows, 0),
                "{\"parameters\":{\"aspect\":0.5,\"/duration\":1,\"model\":\"j2\",\"n\":4},"
                "\"set\":{\"/bodies/0/box/max/1\":0.05,\"/duration\":1,\"/grid/max/-\":7,"
                "\"/materials/sand/a~1b\":0.5,\"/materials/sand/model\":\"j2\",\"/solver/new\":16}"
                "}");
    /* The last parameter changes fastest; 3 * 0.1 is 0.3, and n^2 a whole number. */
    expect_json(json_array_get(plan.rows, 7),
                "{\"parameters\":{\"aspect\":3,\"/duration\":2,\"model\":\"soft\",\"n\":4},"
                "\"set\":{\"/bodies/0/box/max/1\":0.3,\"/duration\":2,\"/grid/max/-\":7,"
                "\"/materials/sand/a~1b\":3,\"/materials/sand/model\":{\"model\":\"tresca\"},"
                "\"/solver/new\":16}}");
    json_t *scene = parse(scene_text), *before = parse(scene_text);
    json_t *changed = study_scene(scene, json_object_get(json_array_get(plan.rows, 7), "set"));
    expect_json(changed,
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
        plan_good("{\"grid\":{\"parameters\":{\"a\":[1,2],\"m\":[{\"label\":\"x\",\"value\":{"
                  "\"friction\":{}}}]},\"set\":{\"/materials/clay/friction/a0\":\"a\","
                  "\"/materials/clay\":\"m\",\"/materials/clay-2\":\"a\"}}}");
    json_t *scene = parse(scene_text);
    (void)state;
    json_t *changed = study_scene(scene, json_object_get(json_array_get(plan.rows, 1), "set"));
    expect_json(json_object_get(json_object_get(changed, "materials"), "clay"),
                "{\"friction\":{\"a0\":2}}");
    json_decref(changed);
    json_decref(scene);
    study_plan_release(&plan);
    expect("{\"grid\":{\"parameters\":{\"a\":[1],\"m\":[{\"label\":\"x\",\"value\":{}}]},"
           "\"set\":{\"/materials/clay/friction/a0\":\"a\",\"/materials/clay\":\"m\"}}}",
           "/design/grid/set/~1materials~1clay~1friction~1a0", "pointer",
           "'/materials/clay/friction'");
}

static void test_list(void **state)
{
    struct study_plan plan =
        plan_good("{\"list\":{\"rows\":[{\"a\":1,\"/duration\":2},{\"/duration\":3,\"a\":4}],"
                  "\"set\":{\"/grid/cell\":\"a/10\"}}}");
    (void)state;
    assert_int_equal(plan.kind, STUDY_LIST);
    expect_json(plan.rows, "[{\"parameters\":{\"a\":1,\"/duration\":2},\"set\":{\"/duration\":2,"
                           "\"/grid/cell\":0.1}},{\"parameters\":{\"a\":4,\"/duration\":3},"
                           "\"set\":{\"/duration\":3,\"/grid/cell\":0.4}}]");
    study_plan_release(&plan);
}

static void test_sample(void **state)
{
    static const char *const methods[] = {"sobol", "latin_hypercube"};
    (void)state;
    for (int method = 0; method < 2; method++) {
        char text[400];
        (void)snprintf(text, sizeof text,
                       "{\"sample\":{\"method\":\"%s\",\"count\":16,\"seed\":%d,\"parameters\":{"
                       "\"/duration\":{\"min\":1,\"max\":3},\"E\":{\"min\":1e3,\"max\":1e7,"
                       "\"scale\":\"log\"}},\"set\":{\"/materials/sand/E\":\"E\"}}}",
                       methods[method], 5 * method);
        struct study_plan plan = plan_good(text);
        bool hit[2][16] = {{false}};
        assert_int_equal(plan.kind, STUDY_SAMPLE);
        assert_int_equal(study_plan_count(&plan), 16);
        for (size_t row = 0; row < 16; row++) {
            const json_t *set = json_object_get(json_array_get(plan.rows, row), "set");
            double duration = json_number_value(json_object_get(set, "/duration"));
            double decades = log10(json_number_value(json_object_get(set, "/materials/sand/E")));
            hit[0][(size_t)((duration - 1.0) * 8.0 + 1e-9)] = true;
            hit[1][(size_t)((decades - 3.0) * 4.0 + 1e-9)] = true;
        }
        for (size_t stratum = 0; stratum < 16; stratum++)
            assert_true(hit[0][stratum] && hit[1][stratum]);
        study_plan_release(&plan);
    }
    /* The same on every machine: written down here. */
    struct study_plan plan =
        plan_good("{\"sample\":{\"method\":\"latin_hypercube\",\"count\":3,\"seed\":1,"
                  "\"parameters\":{\"/duration\":{\"min\":0,\"max\":1}}}}");
    expect_json(plan.rows, "[{\"parameters\":{\"/duration\":0.323667584529},\"set\":{\"/duration\":"
                           "0.323667584529}},{\"parameters\":{\"/duration\":0.481453072352},"
                           "\"set\":{\"/duration\":0.481453072352}},{\"parameters\":{\"/duration\":"
                           "0.814754900275},\"set\":{\"/duration\":0.814754900275}}]");
    study_plan_release(&plan);
}

static void test_work_precision(void **state)
{
    struct study_plan plan = plan_good(
        "{\"work_precision\":{\"variants\":[{\"label\":\"linear\",\"set\":{\"/solver/shape\":"
        "\"linear\"}},{\"label\":\"own\",\"set\":{\"/solver\":{\"shape\":\"gimp\"}}}],"
        "\"resolutions\":[{\"label\":\"coarse\",\"set\":{}},{\"label\":\"fine\",\"set\":{"
        "\"/grid/cell\":0.05,\"/solver/time_step\":0.001}}],\"error\":\"error.tip\","
        "\"cost\":\"particle_steps\"}}");
    (void)state;
    assert_int_equal(plan.kind, STUDY_WORK_PRECISION);
    assert_string_equal(plan.error_metric, "error.tip");
    assert_string_equal(plan.cost_metric, "particle_steps");
    expect_json(plan.names, "[\"variant\",\"resolution\"]");
    assert_int_equal(study_plan_count(&plan), 4);
    expect_json(json_array_get(plan.rows, 3),
                "{\"parameters\":{\"variant\":\"own\",\"resolution\":\"fine\"},\"set\":{"
                "\"/grid/cell\":0.05,\"/solver\":{\"shape\":\"gimp\"},\"/solver/time_step\":0.001}"
                "}");
    study_plan_release(&plan);
    plan = plan_good("{\"work_precision\":{\"variants\":[{\"label\":\"a\",\"set\":{}}],"
                     "\"resolutions\":[{\"label\":\"b\",\"set\":{}}],\"error\":\"error.tip\"}}");
    assert_string_equal(plan.cost_metric, "wall_seconds");
    study_plan_release(&plan);
}

static void test_bisect(void **state)
{
    struct study_plan plan =
        plan_good("{\"bisect\":{\"parameter\":\"/solver/courant\",\"low\":0.1,\"high\":2,"
                  "\"tolerance\":0.01,\"condition\":\"energy_error < 0.01 && n >= 2\"}}");
    (void)state;
    assert_int_equal(plan.kind, STUDY_BISECT);
    assert_string_equal(plan.bisect.parameter, "/solver/courant");
    assert_int_equal(plan.bisect.condition.term_count, 2);
    assert_int_equal(json_array_size(plan.rows), 1);
    assert_int_equal(study_plan_count(&plan), 10); /* 1.9 / 2^8 is below 0.01 */
    json_t *row = study_bisect_row(&plan, json_array_get(plan.rows, 0), 0.5);
    expect_json(row,
                "{\"parameters\":{\"/solver/courant\":0.5},\"set\":{\"/solver/courant\":0.5}}");
    json_decref(row);
    study_plan_release(&plan);
    plan = plan_good("{\"bisect\":{\"parameter\":\"/solver/time_step\",\"low\":0.1,\"high\":2,"
                     "\"tolerance\":5,\"condition\":\"n>1\"}}");
    assert_int_equal(study_plan_count(&plan), 2);
    study_plan_release(&plan);
}

static void test_bisect_for_each(void **state)
{
    struct study_plan plan =
        plan_good("{\"bisect\":{\"parameter\":\"/solver/courant\",\"low\":0.1,\"high\":2,"
                  "\"tolerance\":0.01,\"condition\":\"n<1\",\"for_each\":{\"parameters\":{"
                  "\"/duration\":[1,2,3]},\"set\":{}}}}");
    (void)state;
    assert_int_equal(json_array_size(plan.rows), 3);
    assert_int_equal(study_plan_count(&plan), 30);
    json_t *row = study_bisect_row(&plan, json_array_get(plan.rows, 1), 0.5);
    expect_json(row, "{\"parameters\":{\"/duration\":2,\"/solver/courant\":0.5},"
                     "\"set\":{\"/duration\":2,\"/solver/courant\":0.5}}");
    /* The rows of the plan are as they were. */
    assert_int_equal(json_object_size(json_object_get(json_array_get(plan.rows, 1), "parameters")),
                     1);
    json_decref(row);
    study_plan_release(&plan);
    expect("{\"bisect\":{\"parameter\":\"/duration\",\"low\":0.1,\"high\":2,"
           "\"tolerance\":0.01,\"condition\":\"n<1\",\"for_each\":{\"parameters\":{"
           "\"/duration\":[1,2,3]}}}}",
           "/design/bisect/parameter", "contradiction", "for_each");
    expect("{\"bisect\":{\"parameter\":\"/duration\",\"low\":0.1,\"high\":2,"
           "\"tolerance\":0.01,\"condition\":\"n<1\",\"for_each\":[]}}",
           "/design/bisect/for_each", "type", "object");
}

static void test_design_mistakes(void **state)
{
    (void)state;
    expect("[]", "/design", "type", "object");
    expect("{}", "/design", "required", "'bisect'");
    expect("{\"grid\":5}", "/design/grid", "type", "object");
    expect("{\"list\":{\"rows\":[{\"/duration\":1}]},\"grid\":{}}", "/design", "contradiction", "");
    expect("{\"list\":{\"rows\":[{\"/duration\":1}]},\"gird\":{}}", "/design/gird", "unknown_key",
           "\"grid\"");
}

#define GRID(PARAMETERS, SET) "{\"grid\":{\"parameters\":" PARAMETERS ",\"set\":" SET "}}"

static void test_grid_mistakes(void **state)
{
    (void)state;
    expect("{\"grid\":{}}", "/design/grid/parameters", "required", "");
    expect(GRID("[]", "{}"), "/design/grid/parameters", "type", "object");
    expect(GRID("{}", "{}"), "/design/grid/parameters", "range", "one parameter");
    expect("{\"grid\":{\"parameters\":{\"/duration\":[1]},\"sett\":{}}}", "/design/grid/sett",
           "unknown_key", "\"set\"");
    expect(GRID("{\"/duration\":1}", "{}"), "/design/grid/parameters/~1duration", "type", "array");
    expect(GRID("{\"/duration\":[]}", "{}"), "/design/grid/parameters/~1duration", "range", "one");
    expect(GRID("{\"/duration\":[1,true]}", "{}"), "/design/grid/parameters/~1duration/1", "type",
           "label");
    expect(GRID("{\"/duration\":[{\"value\":1}]}", "{}"),
           "/design/grid/parameters/~1duration/0/label", "required", "");
    expect(GRID("{\"/duration\":[{\"label\":\"a\"}]}", "{}"),
           "/design/grid/parameters/~1duration/0/value", "required", "");
    expect(GRID("{\"/duration\":[{\"label\":\"a\",\"valeu\":1,\"value\":1}]}", "{}"),
           "/design/grid/parameters/~1duration/0/valeu", "unknown_key", "\"value\"");
    expect(GRID("{\"/duration\":[{\"label\":\"\",\"value\":1}]}", "{}"),
           "/design/grid/parameters/~1duration/0/label", "range", "");
    expect(GRID("{\"/duration\":[{\"label\":7,\"value\":1}]}", "{}"),
           "/design/grid/parameters/~1duration/0/label", "type", "");
    expect(GRID("{\"/duration\":[1,2,1]}", "{}"), "/design/grid/parameters/~1duration/2",
           "duplicate", "");
    expect(GRID("{\"/duration\":[\"a\",{\"label\":\"a\",\"value\":2}]}", "{}"),
           "/design/grid/parameters/~1duration/1", "duplicate", "");
    expect(GRID("{\"a\":[1]}", "{}"), "/design/grid/parameters/a", "unused", "'a'");
    expect(GRID("{\"a\":[1]}", "[]"), "/design/grid/set", "type", "object");
    expect(GRID("{\"a b\":[1],\"/duration\":[1]}", "{\"/grid/cell\":\"a b\"}"),
           "/design/grid/parameters/a b", "name", "letters");
    expect(GRID("{\"sin\":[1]}", "{\"/grid/cell\":\"sin\"}"), "/design/grid/parameters/sin", "name",
           "function");
}

static void test_set_mistakes(void **state)
{
    (void)state;
    expect(GRID("{\"a\":[1]}", "{\"/duration\":\"a\",\"/grid/cell\":\"heigth + a\"}"),
           "/design/grid/set/~1grid~1cell", "unknown_name", "at character 1: unknown name heigth");
    expect(GRID("{\"height\":[1]}", "{\"/duration\":\"height\",\"/grid/cell\":\"2 * heigth\"}"),
           "/design/grid/set/~1grid~1cell", "unknown_name", "did you mean 'height'?");
    expect(GRID("{\"a\":[1]}", "{\"/duration\":\"a\",\"/grid/cell\":\"2 * (a\"}"),
           "/design/grid/set/~1grid~1cell", "syntax", "at character 7: a ) is wanted");
    expect(GRID("{\"a\":[1]}", "{\"/duration\":\"a\",\"/grid/cell\":true}"),
           "/design/grid/set/~1grid~1cell", "type", "expression");
    expect(GRID("{\"a\":[2,1,0,0.5]}", "{\"/duration\":\"1 / (a - 1)\"}"),
           "/design/grid/set/~1duration", "not_finite",
           "row 1 {\"a\":1}: a division by zero, at character 3");
    expect(GRID("{\"a\":[1,\"x\"]}", "{\"/duration\":\"a + 1\"}"), "/design/grid/set/~1duration",
           "type", "row 1 {\"a\":\"x\"}: 'a' is not a number");
    expect(GRID("{\"a\":[1]}", "{\"duration\":\"a\"}"), "/design/grid/set/duration", "pointer",
           "/ before each key");
    expect(GRID("{\"a\":[1]}", "{\"\":\"a\"}"), "/design/grid/set/", "pointer", "/ before");
    expect(GRID("{\"a\":[1]}", "{\"/du~ration\":\"a\"}"), "/design/grid/set/~1du~0ration",
           "pointer", "~0 for");
    expect(GRID("{\"a\":[1]}", "{\"/gird/cell\":\"a\"}"), "/design/grid/set/~1gird~1cell",
           "pointer", "no object or array at '/gird'");
    expect(GRID("{\"a\":[1]}", "{\"/grid/cell/x\":\"a\"}"), "/design/grid/set/~1grid~1cell~1x",
           "pointer", "'/grid/cell'");
    expect(GRID("{\"a\":[1]}", "{\"/bodies/7/name\":\"a\"}"), "/design/grid/set/~1bodies~17~1name",
           "pointer", "'/bodies/7' is not an index");
    expect(GRID("{\"a\":[1]}", "{\"/grid/max/x\":\"a\"}"), "/design/grid/set/~1grid~1max~1x",
           "pointer", "index");
    expect(GRID("{\"/gird/cell\":[1]}", "{}"), "/design/grid/parameters/~1gird~1cell", "pointer",
           "no object");
    expect(GRID("{\"a\":[1],\"/duration\":[1]}", "{\"/duration\":\"a\"}"),
           "/design/grid/set/~1duration", "contradiction", "same place");
}

static void test_list_mistakes(void **state)
{
    (void)state;
    expect("{\"list\":{}}", "/design/list/rows", "required", "");
    expect("{\"list\":{\"rows\":[]}}", "/design/list/rows", "range", "one");
    expect("{\"list\":{\"rows\":[5]}}", "/design/list/rows/0", "type", "object");
    expect("{\"list\":{\"rows\":[{}]}}", "/design/list/rows/0", "range", "one");
    expect("{\"list\":{\"rows\":[{\"/duration\":1},{\"/duration\":1},{}]}}",
           "/design/list/rows/2/~1duration", "required", "first row");
    expect("{\"list\":{\"rows\":[{\"/duration\":1},{\"/duration\":1,\"/duratoin\":2}]}}",
           "/design/list/rows/1/~1duratoin", "unknown_key", "/duration");
    expect("{\"list\":{\"rows\":[{\"/duration\":1},{\"/duration\":null}]}}",
           "/design/list/rows/1/~1duration", "type", "number");
    expect("{\"list\":{\"rows\":[{\"a\":1}]}}", "/design/list/rows/0/a", "unused", "");
}

#define SAMPLE(KEYS, RANGE) "{\"sample\":{" KEYS ",\"parameters\":{\"/duration\":{" RANGE "}}}}"
#define SOBOL "\"method\":\"sobol\",\"count\":4"

static void test_sample_mistakes(void **state)
{
    static const char range[] = "/design/sample/parameters/~1duration";
    (void)state;
    expect(SAMPLE("\"count\":4", "\"min\":0,\"max\":1"), "/design/sample/method", "required", "");
    expect(SAMPLE("\"method\":\"sobl\",\"count\":4", "\"min\":0,\"max\":1"),
           "/design/sample/method", "unknown_value", "'sobol'");
    expect(SAMPLE("\"method\":7,\"count\":4", "\"min\":0,\"max\":1"), "/design/sample/method",
           "type", "");
    expect(SAMPLE("\"method\":\"sobol\"", "\"min\":0,\"max\":1"), "/design/sample/count",
           "required", "");
    expect(SAMPLE("\"method\":\"sobol\",\"count\":0", "\"min\":0,\"max\":1"),
           "/design/sample/count", "range", "");
    expect(SAMPLE("\"method\":\"sobol\",\"count\":2.5", "\"min\":0,\"max\":1"),
           "/design/sample/count", "type", "whole");
    expect(SAMPLE("\"method\":\"sobol\",\"count\":101", "\"min\":0,\"max\":1"),
           "/design/sample/count", "range", "at most 100");
    expect(SAMPLE("\"method\":\"sobol\",\"count\":1e15", "\"min\":0,\"max\":1"),
           "/design/sample/count", "range", "at most 100");
    expect(SAMPLE(SOBOL ",\"seed\":-1", "\"min\":0,\"max\":1"), "/design/sample/seed", "range", "");
    expect(SAMPLE(SOBOL ",\"seed\":\"x\"", "\"min\":0,\"max\":1"), "/design/sample/seed", "type",
           "");
    expect(SAMPLE(SOBOL ",\"sede\":1", "\"min\":0,\"max\":1"), "/design/sample/sede", "unknown_key",
           "\"seed\"");
    expect(SAMPLE(SOBOL, "\"min\":0,\"max\":0"), "/design/sample/parameters/~1duration/max",
           "range", "larger");
    expect(SAMPLE(SOBOL, "\"min\":0"), "/design/sample/parameters/~1duration/max", "required", "");
    expect(SAMPLE(SOBOL, "\"min\":\"0\",\"max\":1"), "/design/sample/parameters/~1duration/min",
           "type", "");
    expect(SAMPLE(SOBOL, "\"min\":0,\"max\":1,\"scale\":\"log\""),
           "/design/sample/parameters/~1duration/min", "range", "positive");
    expect(SAMPLE(SOBOL, "\"min\":1,\"max\":2,\"scale\":\"lgo\""),
           "/design/sample/parameters/~1duration/scale", "unknown_value", "'log'");
    expect(SAMPLE(SOBOL, "\"min\":0,\"max\":1,\"steps\":3"),
           "/design/sample/parameters/~1duration/steps", "unknown_key", "");
    expect("{\"sample\":{" SOBOL ",\"parameters\":{\"/duration\":[0,1]}}}", range, "type", "'min'");
    expect("{\"sample\":{" SOBOL ",\"parameters\":{}}}", "/design/sample/parameters", "range", "");
    expect("{\"sample\":{" SOBOL "}}", "/design/sample/parameters", "required", "");
}

#define COMPARE(VARIANTS, RESOLUTIONS, MORE)                                                       \
    "{\"work_precision\":{\"variants\":" VARIANTS ",\"resolutions\":" RESOLUTIONS MORE "}}"
#define ONE "[{\"label\":\"a\",\"set\":{\"/duration\":1}}]"
#define OTHER "[{\"label\":\"b\",\"set\":{\"/grid/cell\":1}}]"
#define TIP ",\"error\":\"error.tip\""

static void test_work_precision_mistakes(void **state)
{
    (void)state;
    expect(COMPARE(ONE, OTHER, ""), "/design/work_precision/error", "required", "");
    expect(COMPARE(ONE, OTHER, ",\"error\":5"), "/design/work_precision/error", "type", "");
    expect(COMPARE(ONE, OTHER, TIP ",\"cost\":\"money\""), "/design/work_precision/cost",
           "unknown_value", "'wall_seconds'");
    expect(COMPARE(ONE, OTHER, TIP ",\"costs\":1"), "/design/work_precision/costs", "unknown_key",
           "\"cost\"");
    expect(COMPARE("[]", OTHER, TIP), "/design/work_precision/variants", "range", "one");
    expect(COMPARE("[5]", OTHER, TIP), "/design/work_precision/variants/0", "type", "object");
    expect(COMPARE("[{\"set\":{}}]", OTHER, TIP), "/design/work_precision/variants/0/label",
           "required", "");
    expect(COMPARE(ONE, "[{\"label\":\"b\"}]", TIP), "/design/work_precision/resolutions/0/set",
           "required", "");
    expect(COMPARE(ONE, "[{\"label\":\"b\",\"set\":{},\"sets\":1}]", TIP),
           "/design/work_precision/resolutions/0/sets", "unknown_key", "\"set\"");
    expect(COMPARE(ONE, "[{\"label\":\"b\",\"set\":{}},{\"label\":\"b\",\"set\":{}}]", TIP),
           "/design/work_precision/resolutions/1/label", "duplicate", "");
    expect(COMPARE(ONE, ONE, TIP), "/design/work_precision/resolutions/0/set/~1duration",
           "contradiction", "variant 'a'");
    expect(COMPARE("[{\"label\":\"a\",\"set\":{\"/gird/cell\":1}}]", OTHER, TIP),
           "/design/work_precision/variants/0/set/~1gird~1cell", "pointer", "'/gird'");
    expect(COMPARE(ONE, "[{\"label\":\"b\",\"set\":{\"cell\":1}}]", TIP),
           "/design/work_precision/resolutions/0/set/cell", "pointer", "/ before");
    expect(COMPARE("[{\"label\":\"a\",\"set\":{\"/grid\":7}}]", OTHER, TIP),
           "/design/work_precision/resolutions/0/set/~1grid~1cell", "pointer", "'/grid'");
}

#define BISECT(PARAMETER, LOW, HIGH, TOLERANCE, CONDITION)                                         \
    "{\"bisect\":{\"parameter\":" PARAMETER ",\"low\":" LOW ",\"high\":" HIGH                      \
    ",\"tolerance\":" TOLERANCE ",\"condition\":" CONDITION "}}"

static void test_bisect_mistakes(void **state)
{
    (void)state;
    expect(BISECT("\"/grid\"", "0", "1", "0.1", "\"n<1\""), "/design/bisect/parameter", "type",
           "number");
    expect(BISECT("\"/bodies/0/name\"", "0", "1", "0.1", "\"n<1\""), "/design/bisect/parameter",
           "type", "number");
    expect(BISECT("\"courant\"", "0", "1", "0.1", "\"n<1\""), "/design/bisect/parameter", "pointer",
           "/ before");
    expect(BISECT("\"/sovler/courant\"", "0", "1", "0.1", "\"n<1\""), "/design/bisect/parameter",
           "pointer", "'/sovler'");
    expect(BISECT("5", "0", "1", "0.1", "\"n<1\""), "/design/bisect/parameter", "type", "text");
    expect(BISECT("\"/duration\"", "1", "1", "0.1", "\"n<1\""), "/design/bisect/high", "range",
           "larger");
    expect(BISECT("\"/duration\"", "\"1\"", "1", "0.1", "\"n<1\""), "/design/bisect/low", "type",
           "number");
    expect(BISECT("\"/duration\"", "0", "1", "0", "\"n<1\""), "/design/bisect/tolerance", "range",
           "positive");
    expect(BISECT("\"/duration\"", "1", "2", "1e-14", "\"n<1\""), "/design/bisect/tolerance",
           "range", "1e-12");
    expect(BISECT("\"/duration\"", "0", "1e300", "1", "\"n<1\""), "/design/bisect/tolerance",
           "range", "");
    expect(BISECT("\"/duration\"", "0", "1", "0.1", "\"n=1\""), "/design/bisect/condition",
           "syntax", "at character 2");
    expect("{\"bisect\":{\"parameter\":\"/duration\",\"low\":0,\"high\":1,\"tolerance\":0.1}}",
           "/design/bisect/condition", "required", "");
    expect("{\"bisect\":{\"parameter\":\"/duration\",\"low\":0,\"high\":1,\"tolerance\":0.1,"
           "\"condition\":\"n<1\",\"conditoin\":1}}",
           "/design/bisect/conditoin", "unknown_key", "\"condition\"");
}

/* 10^12 combinations cost what their text costs: no row is made. */
static void test_too_many(void **state)
{
    struct study_plan plan;
    json_t *parameters = json_object(), *values = json_array(), *scene = parse(scene_text);
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
        json_t *parameters = json_object(), *set = json_object(), *scene = parse(scene_text);
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

/* The number of members in a document, and its member with a number, in depth-first order. */
static json_t *place_find(json_t *value, size_t *number, json_t **parent, const char **key,
                          size_t *index)
{
    const char *name;
    json_t *member;
    size_t position;
    json_object_foreach(value, name, member)
    {
        if ((*number)-- == 0) {
            *parent = value;
            *key = name;
            return member;
        }
        json_t *found = place_find(member, number, parent, key, index);
        if (found != NULL)
            return found;
    }
    json_array_foreach(value, position, member)
    {
        if ((*number)-- == 0) {
            *parent = value;
            *key = NULL;
            *index = position;
            return member;
        }
        json_t *found = place_find(member, number, parent, key, index);
        if (found != NULL)
            return found;
    }
    return NULL;
}

/* Replaces or removes each member of good designs by everything that could stand there: whatever
 * comes, it is a plan whose rows all fit, or at least one mistake under /design. */
static void test_mutations(void **state)
{
    static const char *const designs[] = {
        GRID("{\"a\":[1,2],\"/duration\":[1,{\"label\":\"x\",\"value\":[1]}]}",
             "{\"/grid/cell\":\"a*2\",\"/solver/x\":\"a\"}"),
        "{\"list\":{\"rows\":[{\"a\":1},{\"a\":2}],\"set\":{\"/grid/cell\":\"a\"}}}",
        SAMPLE(SOBOL ",\"seed\":3", "\"min\":1,\"max\":2,\"scale\":\"log\""),
        COMPARE(ONE, OTHER, TIP ",\"cost\":\"wall_seconds\""),
        BISECT("\"/duration\"", "0", "1", "0.1", "\"n<1\""),
    };
    static const char *const replacements[] = {"null",
                                               "true",
                                               "0",
                                               "-1",
                                               "1e308",
                                               "0.5",
                                               "\"\"",
                                               "\"a\"",
                                               "\"/\"",
                                               "\"/grid/cell\"",
                                               "\"1/0\"",
                                               "[]",
                                               "{}",
                                               "[[]]",
                                               "[{}]",
                                               "{\"a\":{}}",
                                               "{\"\":\"\"}",
                                               "{\"/x/y\":\"a\"}",
                                               "[1,1]",
                                               "{\"label\":\"l\",\"value\":null}",
                                               "\"((((\"",
                                               "\"a\\u00e9\"",
                                               "12345678901234567"};
    size_t good = 0, bad = 0;
    json_t *scene = parse(scene_text);
    (void)state;
    for (size_t seed = 0; seed < sizeof designs / sizeof designs[0]; seed++) {
        for (size_t number = 0;; number++) {
            size_t left = number, index = 0, choices = sizeof replacements / sizeof *replacements;
            json_t *parent = NULL, *design = parse(designs[seed]);
            const char *key = NULL;
            bool there = place_find(design, &left, &parent, &key, &index) != NULL;
            json_decref(design);
            if (!there)
                break;
            for (size_t choice = 0; choice <= choices; choice++) {
                struct study_plan plan;
                json_t *errors = json_array();
                design = parse(designs[seed]);
                left = number;
                (void)place_find(design, &left, &parent, &key, &index);
                if (choice == choices && key != NULL)
                    (void)json_object_del(parent, key);
                else if (choice == choices)
                    (void)json_array_remove(parent, index);
                else if (key != NULL)
                    (void)json_object_set_new(parent, key, parse(replacements[choice]));
                else
                    (void)json_array_set_new(parent, index, parse(replacements[choice]));
                if (study_plan_read(scene, design, 100, &plan, errors)) {
                    size_t row;
                    json_t *entry;
                    good++;
                    json_array_foreach(plan.rows, row, entry)
                    {
                        json_t *changed = study_scene(scene, json_object_get(entry, "set"));
                        assert_non_null(changed);
                        json_decref(changed);
                    }
                    study_plan_release(&plan);
                } else {
                    bad++;
                    assert_true(json_array_size(errors) > 0);
                    assert_memory_equal(
                        json_string_value(json_object_get(json_array_get(errors, 0), "pointer")),
                        "/design", 7);
                }
                json_decref(errors);
                json_decref(design);
            }
        }
    }
    json_decref(scene);
    assert_true(good > 50 && bad > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_grid),
        cmocka_unit_test(test_nested_places),
        cmocka_unit_test(test_list),
        cmocka_unit_test(test_sample),
        cmocka_unit_test(test_work_precision),
        cmocka_unit_test(test_bisect),
        cmocka_unit_test(test_bisect_for_each),
        cmocka_unit_test(test_design_mistakes),
        cmocka_unit_test(test_grid_mistakes),
        cmocka_unit_test(test_set_mistakes),
        cmocka_unit_test(test_list_mistakes),
        cmocka_unit_test(test_sample_mistakes),
        cmocka_unit_test(test_work_precision_mistakes),
        cmocka_unit_test(test_bisect_mistakes),
        cmocka_unit_test(test_too_many),
        cmocka_unit_test(test_too_wide),
        cmocka_unit_test(test_mutations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

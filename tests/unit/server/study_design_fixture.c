/* SPDX-License-Identifier: Apache-2.0 */
#include "study_design_fixture.h"

#include <string.h>

const char design_scene[] =
    "{\"duration\":1,\"grid\":{\"cell\":0.1,\"max\":[1,2]},\"solver\":{\"time_step\":\"auto\"},"
    "\"materials\":{\"sand\":{\"model\":\"matsuoka_nakai\",\"a/b\":1}},"
    "\"bodies\":[{\"name\":\"column\",\"box\":{\"max\":[1,1]}}]}";

json_t *design_parse(const char *text)
{
    json_error_t error;
    json_t *value = json_loads(text, JSON_DECODE_ANY, &error);
    if (value == NULL)
        fail_msg("%s: %s", error.text, text);
    return value;
}

struct study_plan design_plan(const char *text)
{
    struct study_plan plan;
    json_t *scene = design_parse(design_scene), *design = design_parse(text),
           *errors = json_array();
    if (!study_plan_read(scene, design, 10000, &plan, errors))
        fail_msg("%s: %s", text, json_dumps(errors, 0));
    assert_int_equal(json_array_size(errors), 0);
    json_decref(errors);
    json_decref(design);
    json_decref(scene);
    return plan;
}

void design_expect(const char *text, const char *pointer, const char *code, const char *part)
{
    struct study_plan plan;
    json_t *scene = design_parse(design_scene), *design = design_parse(text),
           *errors = json_array();
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

void design_expect_json(const json_t *value, const char *text)
{
    json_t *expected = design_parse(text);
    if (!json_equal(value, expected))
        fail_msg("%s\nis not\n%s", json_dumps(value, JSON_ENCODE_ANY), text);
    json_decref(expected);
}

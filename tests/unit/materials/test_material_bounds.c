/* SPDX-License-Identifier: Apache-2.0 */
/* Every bound in the table of every model is enforced by the reader, at the parameter's pointer.
 * The documents are those of the golden curves. */
#include "scene/scene_point.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* material[key] = value; "friction.a0" is a key of a nested object. */
static void set_parameter(json_t *material, const char *key, double value)
{
    char prefix[64];
    const char *dot = strchr(key, '.');
    if (dot == NULL) {
        assert_int_equal(json_object_set_new(material, key, json_real(value)), 0);
        return;
    }
    (void)snprintf(prefix, sizeof prefix, "%.*s", (int)(dot - key), key);
    json_t *inner = json_object_get(material, prefix);
    if (inner == NULL) {
        inner = json_object();
        assert_int_equal(json_object_set_new(material, prefix, inner), 0);
    }
    assert_int_equal(json_object_set_new(inner, dot + 1, json_real(value)), 0);
}

/* True if the document with this value is answered by `code` at the parameter. */
static bool is_refused(const json_t *document, const char *key, double value, const char *code)
{
    char pointer[128];
    struct scene_point point;
    struct scene_issues issues;
    bool found = false;
    json_t *copy = json_deep_copy(document);
    set_parameter(json_object_get(copy, "material"), key, value);
    (void)snprintf(pointer, sizeof pointer, "/material/%s", key);
    if (strchr(key, '.') != NULL)
        *strchr(pointer, '.') = '/';
    if (scene_point_read(copy, &point, &issues) == TALUS_OK)
        scene_point_release(&point);
    for (size_t index = 0; index < issues.count; index++)
        found |= strcmp(issues.items[index].pointer, pointer) == 0 &&
                 strcmp(issues.items[index].code, code) == 0;
    scene_issues_release(&issues);
    json_decref(copy);
    return found;
}

static void check_bound(const json_t *document, const struct parameter *parameter, double bound,
                        bool excluded, double outside)
{
    if (!isfinite(bound))
        return;
    double step = 1e-6 * (1.0 + fabs(bound)) * outside;
    if (!is_refused(document, parameter->key, bound + step, "range"))
        fail_msg("%s beyond %g is not refused", parameter->key, bound);
    if (is_refused(document, parameter->key, bound, "range") != excluded)
        fail_msg("%s at its bound %g: excluded is %d", parameter->key, bound, excluded);
}

static void check_model(const struct material *material, const json_t *document, size_t *bounds)
{
    const struct parameter *parameters[MATERIAL_PARAMETER_MAX];
    size_t count = material_parameters(material, parameters, MATERIAL_PARAMETER_MAX);
    for (size_t index = 0; index < count; index++) {
        const struct parameter *parameter = parameters[index];
        if (parameter->kind != PARAMETER_NUMBER) {
            assert_true(is_refused(document, parameter->key, 0.5, "type"));
            continue;
        }
        *bounds += (size_t)isfinite(parameter->minimum) + (size_t)isfinite(parameter->maximum);
        check_bound(document, parameter, parameter->minimum, parameter->above_minimum, -1.0);
        check_bound(document, parameter, parameter->maximum, parameter->below_maximum, 1.0);
    }
}

static void test_every_bound(void **context)
{
    (void)context;
    size_t bounds = 0;
    for (size_t index = 0; index < material_count; index++) {
        char path[1024];
        (void)snprintf(path, sizeof path, "%s/tests/golden/%s.json", TALUS_SOURCE_DIR,
                       material_table[index]->name);
        json_t *golden = json_load_file(path, 0, NULL);
        assert_non_null(golden);
        check_model(material_table[index], json_object_get(golden, "document"), &bounds);
        json_decref(golden);
    }
    assert_true(bounds > 5 * material_count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_every_bound)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

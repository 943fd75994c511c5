/* SPDX-License-Identifier: Apache-2.0 */
#include "scene_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char *const bases[] = {
    [BASE_PLANE] =
        "{\"dimension\": \"plane_strain\", \"duration\": 2.0,"
        " \"grid\": {\"cell\": 0.5, \"min\": [0, 0], \"max\": [20, 10]},"
        " \"solver\": {\"shape\": \"linear\", \"anti_locking\": {\"control\": \"cell\"}},"
        " \"materials\": {\"soil\": {\"model\": \"drucker_prager_cap\", \"density\": 2000,"
        "   \"bulk_modulus\": 8.33e6, \"shear_modulus\": 3.85e6, \"friction_angle\": 30,"
        "   \"cone_strength\": 10}},"
        " \"gravity\": [0, -9.81],"
        " \"bodies\": [{\"name\": \"heap\", \"material\": \"soil\","
        "   \"box\": {\"min\": [0, 0], \"max\": [4, 2]}, \"particles_per_cell\": [2, 2],"
        "   \"initial_stress\": {\"geostatic\": {\"k0\": 0.5}}}],"
        " \"boundaries\": [{\"name\": \"floor\", \"plane\": {\"point\": [0, 0], \"normal\": [0, "
        "1]},"
        "   \"condition\": \"friction\", \"friction_angle\": 30},"
        "  {\"name\": \"pile\", \"box\": {\"min\": [8, 0], \"max\": [10, 6]},"
        "   \"condition\": \"slip\"}],"
        " \"probes\": [{\"name\": \"runout\", \"kind\": \"front\", \"along\": [1, 0]},"
        "  {\"name\": \"load\", \"kind\": \"reaction\", \"boundary\": \"pile\","
        "   \"face\": \"x_min\", \"component\": \"x\"}],"
        " \"references\": [{\"probe\": \"runout\", \"curve\": [[0, 4], [1, 6]]}]}",
    [BASE_SOLID] =
        "{\"dimension\": \"solid\", \"duration\": 1.0,"
        " \"grid\": {\"cell\": [0.5, 0.5, 0.5], \"min\": [0, 0, 0], \"max\": [10, 10, 10]},"
        " \"materials\": {\"rubber\": {\"model\": \"linear_elastic\", \"density\": 1000,"
        "   \"young_modulus\": 1e6, \"poisson_ratio\": 0.3}},"
        " \"bodies\": [{\"material\": \"rubber\","
        "   \"sphere\": {\"centre\": [5, 5, 5], \"radius\": 1}, \"spacing\": [0.25, 0.25, 0.25],"
        "   \"velocity\": [0, -1, 0]}],"
        " \"boundaries\": [{\"face\": {\"min\": [2, 0, 2], \"max\": [8, 0, 6],"
        "   \"normal\": [0, 1, 0]}, \"condition\": \"stick\"}]}",
    [BASE_FLUID] =
        "{\"dimension\": \"plane_strain\", \"duration\": 0.2,"
        " \"grid\": {\"cell\": 0.01, \"min\": [0, 0], \"max\": [0.3, 0.14]},"
        " \"materials\": {\"water\": {\"model\": \"newtonian_fluid\", \"density\": 1000,"
        "   \"bulk_modulus\": 2e6, \"viscosity\": 0.001}},"
        " \"gravity\": [0, -9.81],"
        " \"bodies\": [{\"material\": \"water\", \"box\": {\"min\": [0, 0], \"max\": [0.06, 0.12]},"
        "   \"count\": [12, 24], \"initial_stress\": \"hydrostatic\"}],"
        " \"boundaries\": [{\"plane\": {\"point\": [0, 0], \"normal\": [0, 1]},"
        "   \"condition\": \"slip\"}]}",
    [BASE_AXIAL] = "{\"dimension\": \"axisymmetric\", \"duration\": 0.2,"
                   " \"grid\": {\"cell\": 0.1, \"min\": [0, 0], \"max\": [2, 2]},"
                   " \"materials\": {\"rubber\": {\"model\": \"linear_elastic\", \"density\": 1000,"
                   "   \"young_modulus\": 1e6, \"poisson_ratio\": 0.3}},"
                   " \"gravity\": [0, -9.81],"
                   " \"bodies\": [{\"material\": \"rubber\", \"velocity\": [0, 1],"
                   "   \"sphere\": {\"centre\": [0, 1], \"radius\": 0.5}, \"spacing\": 0.05}]}",
};

static json_t *parse(const char *text)
{
    json_error_t error;
    json_t *value = json_loads(text, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, &error);
    if (value == NULL) {
        (void)fprintf(stderr, "%s: %s\n", text, error.text);
        abort();
    }
    return value;
}

json_t *fixture_scene(enum fixture_base base)
{
    return parse(bases[base]);
}

void fixture_change(json_t *root, const char *pointer, const char *value)
{
    char path[256], *rest = path + 1, *key;
    json_t *place = root;
    (void)snprintf(path, sizeof path, "%s", pointer);
    key = strsep(&rest, "/");
    for (; rest != NULL; key = strsep(&rest, "/")) {
        place = json_is_array(place) ? json_array_get(place, strtoul(key, NULL, 10))
                                     : json_object_get(place, key);
        if (place == NULL)
            abort();
    }
    int failed;
    if (json_is_object(place))
        failed = value == NULL ? json_object_del(place, key)
                               : json_object_set_new(place, key, parse(value));
    else if (strcmp(key, "-") == 0)
        failed = json_array_append_new(place, parse(value));
    else
        failed = json_array_set_new(place, strtoul(key, NULL, 10), parse(value));
    if (failed != 0)
        abort();
}

void fixture_read(const json_t *root, struct fixture_result *result)
{
    result->status =
        scene_read(root, &result->scene, &result->effective, &result->issues, &result->warnings);
}

struct fixture_result fixture_read_valid(json_t *scene)
{
    struct fixture_result result;
    fixture_read(scene, &result);
    for (size_t index = 0; index < result.issues.count; index++)
        (void)fprintf(stderr, "%s: %s\n", result.issues.items[index].pointer,
                      result.issues.items[index].detail);
    assert_int_equal(result.status, TALUS_OK);
    json_decref(scene);
    return result;
}

void fixture_result_release(struct fixture_result *result)
{
    talus_scene_release(&result->scene);
    json_decref(result->effective);
    scene_issues_release(&result->issues);
    scene_issues_release(&result->warnings);
}

const struct scene_issue *fixture_find(const struct scene_issues *issues, const char *pointer,
                                       const char *code)
{
    for (size_t index = 0; index < issues->count; index++) {
        if (strcmp(issues->items[index].pointer, pointer) == 0 &&
            strcmp(issues->items[index].code, code) == 0)
            return &issues->items[index];
    }
    return NULL;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Every model of the table has a curve on record, and still gives it. Curves are made by
 * update_golden.py; a file that belongs to no model is a mistake too. */
#include "scene/scene_point.h"

#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* Compilers and instruction sets round differently; a path of some dozen steps keeps 1e-9. */
static const double tolerance = 1e-9;

struct comparison {
    const struct material *material;
    const json_t *steps;
    double stress_scale, energy_scale;
};

static void assert_value(const struct comparison *comparison, const json_t *expected, double value,
                         double scale, size_t step)
{
    assert_true(json_is_number(expected));
    double difference = fabs(json_number_value(expected) - value);
    if (!(difference <= tolerance * scale))
        fail_msg("%s, step %zu: %.17g instead of %.17g", comparison->material->name, step, value,
                 json_number_value(expected));
}

static void compare_step(void *context, const struct material_point_step *step)
{
    const struct comparison *comparison = context;
    if (step->step == 0)
        return;
    const json_t *expected = json_array_get(comparison->steps, step->step - 1);
    const json_t *state = json_object_get(expected, "state");
    for (size_t component = 0; component < SYM3_COMPONENTS; component++) {
        assert_value(comparison, json_array_get(json_object_get(expected, "strain"), component),
                     step->strain[component], 1.0, step->step);
        assert_value(comparison, json_array_get(json_object_get(expected, "stress"), component),
                     step->stress[component], comparison->stress_scale, step->step);
    }
    assert_value(comparison, json_object_get(expected, "plastic_strain"), step->plastic_strain, 1.0,
                 step->step);
    assert_value(comparison, json_object_get(expected, "dissipation"), step->dissipation,
                 comparison->energy_scale, step->step);
    assert_value(comparison, json_object_get(expected, "strain_energy"), step->strain_energy,
                 comparison->energy_scale, step->step);
    assert_int_equal(json_object_size(state), comparison->material->state_count);
    for (size_t index = 0; index < comparison->material->state_count; index++)
        assert_value(comparison, json_object_get(state, comparison->material->state_names[index]),
                     step->history[index], 1.0 + fabs(step->history[index]), step->step);
}

/* Largest stress and energy of the curve. */
static void find_scales(struct comparison *comparison)
{
    size_t index;
    json_t *step;
    json_array_foreach(comparison->steps, index, step)
    {
        for (size_t component = 0; component < SYM3_COMPONENTS; component++) {
            const json_t *stress = json_array_get(json_object_get(step, "stress"), component);
            comparison->stress_scale =
                fmax(comparison->stress_scale, fabs(json_number_value(stress)));
        }
        double energy = json_number_value(json_object_get(step, "strain_energy")) +
                        json_number_value(json_object_get(step, "dissipation"));
        comparison->energy_scale = fmax(comparison->energy_scale, energy);
    }
}

static void check_file(const struct material *material, const char *path)
{
    json_error_t json_error;
    struct scene_point point;
    struct scene_issues issues;
    struct talus_error error = {.status = TALUS_OK};
    size_t step_count = 0;
    json_t *golden = json_load_file(path, 0, &json_error);
    if (golden == NULL)
        fail_msg("%s: %s", path, json_error.text);
    enum talus_status status =
        scene_point_read(json_object_get(golden, "document"), &point, &issues);
    if (status != TALUS_OK)
        fail_msg("%s: %s %s", path, issues.items[0].pointer, issues.items[0].detail);
    struct comparison comparison = {.material = material,
                                    .steps = json_object_get(golden, "steps")};
    for (size_t segment = 0; segment < point.segment_count; segment++)
        step_count += point.path[segment].step_count;
    assert_ptr_equal(material_table[point.material.model_index], material);
    assert_int_equal(json_array_size(comparison.steps), step_count);
    find_scales(&comparison);
    const struct material_point_path run = scene_point_path(&point);
    status = material_point_run(material, point.material.values, &run, compare_step, &comparison,
                                &error);
    if (status != TALUS_OK)
        fail_msg("%s: %s", path, error.text);
    scene_point_release(&point);
    scene_issues_release(&issues);
    json_decref(golden);
}

static void test_every_model_has_a_file(void **context)
{
    (void)context;
    for (size_t index = 0; index < material_count; index++) {
        char path[1024];
        (void)snprintf(path, sizeof path, "%s/%s.json", TALUS_GOLDEN_DIR,
                       material_table[index]->name);
        if (access(path, R_OK) != 0)
            fail_msg("%s is missing", path);
    }
}

/* MODEL.json, and MODEL-VARIANT.json for what one curve cannot show. */
static void test_every_file(void **context)
{
    (void)context;
    glob_t files;
    assert_int_equal(glob(TALUS_GOLDEN_DIR "/*.json", 0, NULL, &files), 0);
    for (size_t index = 0; index < files.gl_pathc; index++) {
        char name[64];
        const char *path = files.gl_pathv[index];
        assert_int_equal(sscanf(strrchr(path, '/'), "/%63[a-z0-9_]", name), 1);
        const struct material *material = material_find(name);
        if (material == NULL)
            fail_msg("%s belongs to no model", path);
        check_file(material, path);
    }
    globfree(&files);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_model_has_a_file),
        cmocka_unit_test(test_every_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

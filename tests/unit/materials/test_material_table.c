/* SPDX-License-Identifier: Apache-2.0 */
/* The table of models and the parameters that they share. */
#include "material_fixture.h"

#include <glob.h>
#include <stdio.h>

static void test_names_find_their_model(void **context)
{
    (void)context;
    for (size_t index = 0; index < material_count; index++)
        assert_ptr_equal(material_find(material_table[index]->name), material_table[index]);
    assert_null(material_find("rubber"));
}

static bool defines_material(const char *path, char symbol[64])
{
    char line[256];
    bool found = false;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (!found && fgets(line, sizeof line, file) != NULL)
        found = sscanf(line, "const struct material %63[a-z0-9_] = {", symbol) == 1;
    assert_int_equal(fclose(file), 0);
    return found;
}

/* A file without its line in materials.def would compile and never run. */
static void test_every_file_is_listed(void **context)
{
    (void)context;
    glob_t files;
    size_t found = 0;
    assert_int_equal(glob(TALUS_SOURCE_DIR "/solver/materials/*.c", 0, NULL, &files), 0);
    for (size_t index = 0; index < files.gl_pathc; index++) {
        char symbol[64];
        if (!defines_material(files.gl_pathv[index], symbol))
            continue;
        found++;
        if (material_find(symbol) == NULL)
            fail_msg("%s is not in materials.def", files.gl_pathv[index]);
    }
    globfree(&files);
    assert_int_equal(found, material_count);
}

static bool in_bounds(const struct parameter *parameter, double value)
{
    bool low = parameter->above_minimum ? value > parameter->minimum : value >= parameter->minimum;
    bool high = parameter->below_maximum ? value < parameter->maximum : value <= parameter->maximum;
    return low && high;
}

static void check_parameter(const struct material *material, const struct parameter *parameter,
                            size_t index)
{
    assert_int_equal(material_parameter_index(material, parameter->key), index);
    assert_non_null(parameter->unit);
    assert_non_null(parameter->symbol);
    assert_true(strlen(parameter->meaning) > 10);
    assert_true(parameter->minimum <= parameter->maximum);
    if (!isnan(parameter->default_value))
        assert_true(in_bounds(parameter, parameter->default_value));
    assert_false(parameter->required && !isnan(parameter->default_value));
    if (parameter->kind == PARAMETER_CHOICE) {
        size_t count = 0;
        while (parameter->choices[count] != NULL)
            count++;
        assert_true(parameter->minimum == 0.0 && parameter->maximum == (double)count - 1.0);
    }
}

static void test_parameters(void **context)
{
    (void)context;
    for (size_t model = 0; model < material_count; model++) {
        const struct material *material = material_table[model];
        const struct parameter *parameters[MATERIAL_PARAMETER_MAX];
        size_t count = material_parameters(material, parameters, MATERIAL_PARAMETER_MAX);
        assert_in_range(count, 2, MATERIAL_PARAMETER_MAX);
        assert_int_equal(material_parameters(material, NULL, 0), count);
        assert_string_equal(parameters[MATERIAL_VALUE_DENSITY]->key, "density");
        for (size_t index = 0; index < count; index++)
            check_parameter(material, parameters[index], index);
        assert_int_equal(material_parameter_index(material, "colour"), (size_t)-1);
    }
}

static void test_elastic_constants(void **context)
{
    (void)context;
    const struct setting moduli[] = {
        {"density", 2000.0}, {"bulk_modulus", 1e7}, {"shear_modulus", 4e6}};
    double young = 9.0 * 1e7 * 4e6 / (3.0 * 1e7 + 4e6);
    double poisson = (3.0 * 1e7 - 2.0 * 4e6) / (2.0 * (3.0 * 1e7 + 4e6));
    const struct setting pair[] = {
        {"density", 2000.0}, {"young_modulus", young}, {"poisson_ratio", poisson}};
    struct fixture fixture;
    double bulk, shear;
    fixture_init(&fixture, "linear_elastic", moduli, LENGTH(moduli));
    material_elastic_moduli(fixture.material, fixture.values, &bulk, &shear);
    assert_true(bulk == 1e7 && shear == 4e6);
    double speed = fixture.material->wave_speed(fixture.constants);
    assert_true(fabs(speed - sqrt((1e7 + 4.0 / 3.0 * 4e6) / 2000.0)) < 1e-10 * speed);
    fixture_release(&fixture);
    fixture_init(&fixture, "linear_elastic", pair, LENGTH(pair));
    material_elastic_moduli(fixture.material, fixture.values, &bulk, &shear);
    assert_true(fabs(bulk - 1e7) < 1e-8 * bulk && fabs(shear - 4e6) < 1e-8 * shear);
    fixture_release(&fixture);
    const struct setting fluid[] = {{"density", 1000.0}, {"bulk_modulus", 2e9}};
    fixture_init(&fixture, "newtonian_fluid", fluid, LENGTH(fluid));
    material_elastic_moduli(fixture.material, fixture.values, &bulk, &shear);
    assert_true(bulk == 2e9 && shear == 0.0);
    assert_true(material_initial_friction_angle_deg(fixture.material, fixture.values) == 0.0);
    fixture_release(&fixture);
}

struct mistake {
    const char *model;
    struct setting settings[10];
    const char *key, *code; /* expected */
};

#define SOLID                                                                                      \
    {"density", 2000.0}, {"bulk_modulus", 5e6},                                                    \
    {                                                                                              \
        "shear_modulus", 3e6                                                                       \
    }
#define CAP                                                                                        \
    SOLID, {"friction_angle", 30.0},                                                               \
    {                                                                                              \
        "cone_strength", 1e3                                                                       \
    }
#define HARDENING                                                                                  \
    SOLID,                                                                                         \
    {                                                                                              \
        "friction.a0", 30.0                                                                        \
    }

#define FRICTION                                                                                   \
    SOLID, {"friction_angle", 30.0},                                                               \
    {                                                                                              \
        "cohesion", 1e3                                                                            \
    }

static const struct mistake mistakes[] = {
    {"linear_elastic",
     {{"density", 1.0}, {"bulk_modulus", 1.0}, {"poisson_ratio", 0.2}},
     "poisson_ratio",
     "contradiction"},
    {"j2",
     {{"density", 1.0}, {"young_modulus", 1.0}, {"shear_modulus", 0.2}, {"yield_stress", 1.0}},
     "shear_modulus",
     "contradiction"},
    {"drucker_prager_cap", {CAP, {"dilation_angle", 31.0}}, "dilation_angle", "limit"},
    {"drucker_prager_cap", {CAP, {"flow_slope", 0.4}}, "flow_slope", "limit"},
    {"drucker_prager_cap", {CAP, {"flow_ratio", -2.0}}, "flow_ratio", "limit"},
    {"drucker_prager_cap",
     {CAP, {"dilation_angle", 10.0}, {"cone_fit", 2.0}},
     "dilation_angle",
     "contradiction"},
    {"drucker_prager_cap",
     {SOLID, {"cone_slope", 0.82}, {"cone_strength", 1e3}},
     "cone_slope",
     "limit"},
    {"drucker_prager_cap",
     {SOLID, {"cone_slope", 0.41}, {"cone_strength", 1e3}, {"cone_fit", 1.0}},
     "cone_slope",
     "limit"},
    {"drucker_prager_cap",
     {{"density", 2000.0},
      {"bulk_modulus", 1e6},
      {"shear_modulus", 6e6},
      {"cone_slope", 0.8},
      {"cone_strength", 1e3},
      {"flow_slope", -1.4}},
     "flow_slope",
     "limit"},
    {"drucker_prager",
     {SOLID, {"friction_angle", 25.0}, {"flow_slope", 0.4}},
     "flow_slope",
     "limit"},
    {"drucker_prager",
     {SOLID, {"friction_angle", 25.0}, {"flow_ratio", -2.0}},
     "flow_ratio",
     "limit"},
    {"drucker_prager",
     {SOLID, {"friction_angle", 25.0}, {"dilation_angle", 10.0}, {"cone_fit", 2.0}},
     "dilation_angle",
     "contradiction"},
    {"drucker_prager_mobilised",
     {HARDENING, {"friction.a5", 10.0}, {"dilation_angle", 5.0}},
     "dilation_angle",
     "contradiction"},
    {"matsuoka_nakai",
     {SOLID, {"friction_angle", 30.0}, {"dilation_angle", 31.0}},
     "dilation_angle",
     "limit"},
    {"matsuoka_nakai",
     {SOLID, {"friction_angle", 0.0}, {"cohesion", 10.0}},
     "cohesion",
     "contradiction"},
    {"newtonian_fluid",
     {{"density", 1000.0}, {"bulk_modulus", 2e6}, {"exponent", 7.0}},
     "exponent",
     "contradiction"},
    {"mohr_coulomb", {FRICTION, {"dilation_angle", 31.0}}, "dilation_angle", "contradiction"},
    {"mohr_coulomb", {FRICTION, {"tensile_strength", 1.8e3}}, "tensile_strength", "contradiction"},
    {"mohr_coulomb",
     {FRICTION, {"residual_friction_angle", 31.0}, {"softening_rate", 1.0}},
     "residual_friction_angle",
     "contradiction"},
    {"mohr_coulomb", {FRICTION, {"residual_cohesion", 500.0}}, "softening_rate", "incomplete"},
    {"mohr_coulomb", {FRICTION, {"softening_rate", 1.0}}, "softening_rate", "contradiction"},
    {"tresca",
     {SOLID, {"cohesion", 1e3}, {"residual_cohesion", 1.1e3}, {"softening_rate", 1.0}},
     "residual_cohesion",
     "contradiction"},
    {"tresca",
     {SOLID, {"cohesion", 1e3}, {"softening_rate", 1.0}},
     "softening_rate",
     "contradiction"},
};

static void test_contradictions(void **context)
{
    (void)context;
    for (size_t index = 0; index < LENGTH(mistakes); index++) {
        const struct mistake *mistake = &mistakes[index];
        const struct material *material = material_find(mistake->model);
        double values[MATERIAL_PARAMETER_MAX];
        struct material_issue issues[4] = {0};
        size_t count = 0;
        while (count < LENGTH(mistake->settings) && mistake->settings[count].key != NULL)
            count++;
        values_set(material, mistake->settings, count, values);
        assert_int_equal(material->check(values, issues, LENGTH(issues)), 1);
        assert_string_equal(issues[0].key, mistake->key);
        assert_string_equal(issues[0].code, mistake->code);
        assert_true(strlen(issues[0].text) > 20);
        assert_int_equal(material->check(values, issues, 0), 0); /* no room: nothing written */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_find_their_model),
        cmocka_unit_test(test_every_file_is_listed),
        cmocka_unit_test(test_parameters),
        cmocka_unit_test(test_elastic_constants),
        cmocka_unit_test(test_contradictions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

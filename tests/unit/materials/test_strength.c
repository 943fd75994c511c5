/* SPDX-License-Identifier: Apache-2.0 */
/* Strengths of Mohr-Coulomb and Tresca along paths of a material point, peak and residual, in
 * closed form. Perfectly plastic stress is reached to round-off of the mixed control, 1e-9. */
#include "material_fixture.h"

static const double young = 20e6;
static const double poisson = 0.25;
static const double shear_modulus = 8e6; /* E / (2 (1 + nu)) */
static const double tolerance = 1e-9;

#define ELASTIC                                                                                    \
    {"density", 2000.0}, {"young_modulus", young},                                                 \
    {                                                                                              \
        "poisson_ratio", poisson                                                                   \
    }

static void assert_stress(double value, double expected)
{
    if (!(fabs(value - expected) <= tolerance * fmax(fabs(expected), 1e3)))
        fail_msg("%.12g instead of %.12g", value, expected);
}

/* (1 + sin)/(1 - sin) */
static double slope_of(double angle_deg)
{
    double sine = sin(angle_deg * M_PI / 180.0);
    return (1.0 + sine) / (1.0 - sine);
}

static const struct material_point_step *last_step(const struct record *record)
{
    return &record->steps[record->count - 1];
}

static void run(struct record *record, const char *model, const struct setting *settings,
                size_t count, double lateral, struct material_point_segment segment)
{
    const double initial[SYM3_COMPONENTS] = {lateral, lateral, lateral};
    struct fixture fixture;
    segment.duration = 1.0;
    fixture_init(&fixture, model, settings, count);
    record_run(record, &fixture, false, initial, &segment, 1);
    fixture_release(&fixture);
}

/* Axial strain at constant lateral stress ends at s3 = k s1 - 2 c sqrt(k). There all strain is
 * plastic: each of the two planes of the edge shortens the axis by 1 and widens a side by m. */
static void check_triaxial(const struct setting *settings, size_t count, double friction_deg,
                           double dilation_deg, double cohesion)
{
    struct record record;
    double k = slope_of(friction_deg);
    run(&record, "mohr_coulomb", settings, count, -1e5,
        (struct material_point_segment){.strain_given = {[1] = true},
                                        .strain = {[1] = -0.4},
                                        .stress_given = {[0] = true, [2] = true},
                                        .stress = {[0] = -1e5, [2] = -1e5},
                                        .step_count = 400});
    assert_stress(last_step(&record)->stress[1], -1e5 * k - 2.0 * cohesion * sqrt(k));
    const struct material_point_step *end = last_step(&record);
    const struct material_point_step *before = end - 1;
    double volumetric = end->volumetric_strain - before->volumetric_strain;
    double axial = end->strain[1] - before->strain[1];
    assert_true(fabs(volumetric / axial - (1.0 - slope_of(dilation_deg))) < 1e-6);
    record_release(&record);
}

static void test_triaxial_compression(void **context)
{
    (void)context;
    const struct setting perfect[] = {
        ELASTIC, {"friction_angle", 30.0}, {"dilation_angle", 8.0}, {"cohesion", 5e3}};
    const struct setting softening[] = {ELASTIC,
                                        {"friction_angle", 30.0},
                                        {"dilation_angle", 8.0},
                                        {"cohesion", 5e3},
                                        {"residual_friction_angle", 20.0},
                                        {"residual_cohesion", 1e3},
                                        {"softening_rate", 100.0}};
    const struct setting loose[] = {ELASTIC,
                                    {"friction_angle", 30.0},
                                    {"dilation_angle", 8.0},
                                    {"residual_friction_angle", 5.0},
                                    {"softening_rate", 100.0}};
    check_triaxial(perfect, LENGTH(perfect), 30.0, 8.0, 5e3);
    check_triaxial(softening, LENGTH(softening), 20.0, 8.0, 1e3);
    check_triaxial(loose, LENGTH(loose), 5.0, 5.0, 0.0); /* no more dilation than friction */
}

/* Uniaxial tension: 2 c / sqrt(k), or the tensile strength. */
static void check_tension(const struct setting *settings, size_t count, double expected)
{
    struct record record;
    run(&record, "mohr_coulomb", settings, count, 0.0,
        (struct material_point_segment){.strain_given = {true},
                                        .strain = {0.01},
                                        .stress_given = {[1] = true, [2] = true},
                                        .step_count = 50});
    assert_stress(last_step(&record)->stress[0], expected);
    record_release(&record);
}

static void test_tension(void **context)
{
    (void)context;
    const struct setting settings[] = {
        ELASTIC, {"friction_angle", 30.0}, {"cohesion", 5e3}, {"tensile_strength", 1e3}};
    check_tension(settings, LENGTH(settings) - 1, 2.0 * 5e3 / sqrt(3.0));
    check_tension(settings, LENGTH(settings), 1e3);
}

/* Simple shear: tau = c of the plastic strain at the start of the step, which is gamma - tau/G. */
static void test_tresca_shear(void **context)
{
    (void)context;
    enum { STEPS = 500 };
    const double peak = 5e3;
    const double residual = 1.5e3;
    const double rate = 30.0;
    const struct setting settings[] = {
        ELASTIC, {"cohesion", peak}, {"residual_cohesion", residual}, {"softening_rate", rate}};
    struct record record;
    double largest = 0.0;
    run(&record, "tresca", settings, LENGTH(settings), -2e4,
        (struct material_point_segment){
            .strain_given = {[3] = true}, .strain = {[3] = 1.0}, .step_count = STEPS});
    for (size_t step = 1; step <= STEPS; step++) {
        const struct material_point_step *now = &record.steps[step];
        double gamma = 2.0 * now->strain[3];
        double cohesion = residual + (peak - residual) * exp(-rate * record.history[step - 1][0]);
        assert_stress(now->stress[3], fmin(cohesion, gamma * shear_modulus));
        assert_true(fabs(record.history[step][0] - (gamma - now->stress[3] / shear_modulus)) <
                    1e-12);
        largest = fmax(largest, now->stress[3]);
    }
    assert_stress(largest, peak);
    assert_stress(last_step(&record)->stress[3], residual);
    assert_stress(last_step(&record)->p, -2e4); /* flow at constant volume */
    record_release(&record);
}

/* Along any direction of the deviator, and back. */
static void test_tresca_axial(void **context)
{
    (void)context;
    const struct setting settings[] = {ELASTIC, {"cohesion", 5e3}};
    for (int sign = -1; sign <= 1; sign += 2) {
        struct record record;
        run(&record, "tresca", settings, LENGTH(settings), -2e4,
            (struct material_point_segment){.strain_given = {[1] = true},
                                            .strain = {[1] = 0.05 * sign},
                                            .stress_given = {[0] = true, [2] = true},
                                            .stress = {[0] = -2e4, [2] = -2e4},
                                            .step_count = 50});
        assert_stress(last_step(&record)->stress[1], -2e4 + sign * 2.0 * 5e3);
        record_release(&record);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_triaxial_compression),
        cmocka_unit_test(test_tension),
        cmocka_unit_test(test_tresca_shear),
        cmocka_unit_test(test_tresca_axial),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

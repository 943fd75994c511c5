/* SPDX-License-Identifier: Apache-2.0 */
/* Hardening in closed form, and a back strain that turns with the material. */
#include "material_fixture.h"

#include "math/tensor.h"

static const double young = 200e6;
static const double yield_stress = 1e6;

static void init(struct fixture *fixture, double isotropic, double kinematic)
{
    const struct setting settings[] = {{"density", 2000.0},
                                       {"young_modulus", young},
                                       {"poisson_ratio", 0.3},
                                       {"yield_stress", yield_stress},
                                       {"isotropic_hardening", isotropic},
                                       {"kinematic_hardening", kinematic}};
    fixture_init(fixture, "j2", settings, LENGTH(settings));
}

static struct material_point_segment uniaxial(double strain, size_t step_count)
{
    return (struct material_point_segment){
        .strain_given = {true},
        .strain = {strain},
        .stress_given = {[1] = true, [2] = true},
        .duration = 1.0,
        .step_count = step_count,
    };
}

static void assert_near(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected)))
        fail_msg("%.12g instead of %.12g", value, expected);
}

/* Tension, then compression. Under tension sigma = sY + (k + H) eps_p; the way back is elastic over
 * 2 (sY + k eps_p) whatever H is. */
static void check_uniaxial(double isotropic, double kinematic)
{
    const double zero[SYM3_COMPONENTS] = {0};
    const struct material_point_segment path[] = {uniaxial(0.02, 40), uniaxial(-0.03, 100)};
    double hardening = isotropic + kinematic;
    struct fixture fixture;
    struct record record;
    init(&fixture, isotropic, kinematic);
    record_run(&record, &fixture, false, zero, path, 2);
    double plastic = (young * 0.02 - yield_stress) / (young + hardening);
    double peak = yield_stress + hardening * plastic;
    assert_near(record.steps[40].stress[0], peak, 1e-9);
    assert_near(record.history[40][0], plastic, 1e-9); /* equivalent plastic strain */
    assert_near(record.history[40][1], plastic, kinematic > 0.0 ? 1e-9 : 1.0);
    assert_near(record.steps[40].plastic_strain, sqrt(1.5) * plastic, 1e-9);

    double range = 2.0 * (yield_stress + isotropic * plastic);
    double reversed = (young * 0.05 - range) / (young + hardening); /* plastic strain of the way */
    double low = peak - range - hardening * reversed;
    assert_near(record.steps[140].stress[0], low, 1e-9);
    assert_near(record.history[140][0], plastic + reversed, 1e-9);
    record_release(&record);
    fixture_release(&fixture);
}

static void test_uniaxial(void **context)
{
    (void)context;
    check_uniaxial(0.0, 0.0);
    check_uniaxial(20e6, 0.0);
    check_uniaxial(0.0, 30e6);
    check_uniaxial(20e6, 30e6);
}

/* The work of a path is what it stores and dissipates, to the order of the trapezoidal rule. */
static void test_work_is_stored_or_lost(void **context)
{
    (void)context;
    const double zero[SYM3_COMPONENTS] = {0};
    const struct material_point_segment path[] = {uniaxial(0.02, 2000), uniaxial(-0.03, 5000)};
    struct fixture fixture;
    struct record record;
    init(&fixture, 20e6, 30e6);
    record_run(&record, &fixture, false, zero, path, 2);
    double work = 0.0;
    for (size_t step = 1; step < record.count; step++) {
        const struct material_point_step *last = &record.steps[step - 1];
        const struct material_point_step *now = &record.steps[step];
        work += 0.5 * (now->stress[0] + last->stress[0]) * (now->strain[0] - last->strain[0]);
    }
    const struct material_point_step *end = &record.steps[record.count - 1];
    assert_near(end->strain_energy + end->dissipation, work, 1e-4);
    assert_true(end->dissipation > 0.3 * work);
    record_release(&record);
    fixture_release(&fixture);
}

static struct mat3 rotation(double angle)
{
    /* about (1, 1, 1): all components take part */
    double c = cos(angle);
    double s = sin(angle) / sqrt(3.0);
    double t = (1.0 - c) / 3.0;
    return (struct mat3){{{t + c, t - s, t + s}, {t + s, t + c, t - s}, {t - s, t + s, t + c}}};
}

static void set_gradient(struct material_point_segment *segment, struct mat3 gradient)
{
    *segment =
        (struct material_point_segment){.gradient_given = true, .duration = 1.0, .step_count = 1};
    memcpy(segment->gradient, gradient.m, sizeof segment->gradient);
}

/* Stretch far into hardening, spin by 200 degrees in 100 steps, stretch further: as without the
 * spin, but turned. The spin itself changes nothing. */
static void test_superposed_rotation(void **context)
{
    (void)context;
    enum { STRETCHES = 20, TURNS = 100, PATH = STRETCHES + TURNS + STRETCHES };
    const double zero[SYM3_COMPONENTS] = {0};
    static struct material_point_segment turned[PATH];
    static struct material_point_segment still[PATH];
    struct mat3 gradient = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    double angle = 0.0;
    for (int index = 0; index < PATH; index++) {
        bool stretches = index < STRETCHES || index >= STRETCHES + TURNS;
        int count =
            index < STRETCHES ? index + 1 : (stretches ? index + 1 - TURNS : (int)STRETCHES);
        if (!stretches)
            angle += 2.0 * M_PI / 180.0;
        gradient.m[0][0] = 1.0 + 0.004 * count;
        gradient.m[1][1] = 1.0 - 0.001 * count;
        gradient.m[0][1] = 0.006 * count;
        set_gradient(&still[index], gradient);
        set_gradient(&turned[index], mat3_multiply(rotation(angle), gradient));
    }
    struct fixture fixture;
    struct record with;
    struct record without;
    init(&fixture, 20e6, 30e6);
    record_run(&with, &fixture, true, zero, turned, PATH);
    record_run(&without, &fixture, true, zero, still, PATH);
    const double *a = with.steps[PATH].stress;
    const double *b = without.steps[PATH].stress;
    struct sym3 stress = {a[0], a[1], a[2], a[3], a[4], a[5]};
    struct sym3 expected =
        sym3_push_forward(rotation(angle), (struct sym3){b[0], b[1], b[2], b[3], b[4], b[5]});
    assert_true(without.steps[PATH].plastic_strain > 0.05);
    assert_near(with.steps[PATH].plastic_strain, without.steps[PATH].plastic_strain, 1e-10);
    assert_true(sym3_norm(sym3_add_scaled(stress, -1.0, expected)) < 1e-9 * sym3_norm(expected));
    record_release(&with);
    record_release(&without);
    fixture_release(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uniaxial),
        cmocka_unit_test(test_work_is_stored_or_lost),
        cmocka_unit_test(test_superposed_rotation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

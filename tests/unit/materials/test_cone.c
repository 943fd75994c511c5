/* SPDX-License-Identifier: Apache-2.0 */
/* Cone slopes against a table (outer, inner, both plane strain fits), and what the models make of
 * the alternatives for the same cone. */
#include "material_fixture.h"

#include "materials/cap_return.h"
#include "materials/cone.h"

static const double radians = M_PI / 180.0;

static void test_slopes(void **context)
{
    (void)context;
    static const struct {
        double angle, outer, inner, associated, plane;
    } rows[] = {
        {5, .04886, .04610, .04103, .04109},  {10, .10033, .08935, .08145, .08186},
        {15, .15419, .12969, .12067, .12201}, {20, .21013, .16712, .15818, .16123},
        {25, .26777, .20164, .19355, .19922}, {30, .32660, .23328, .22646, .23570},
        {35, .38602, .26210, .25668, .27039}, {40, .44530, .28815, .28408, .30301},
        {45, .50360, .31148, .30861, .33333},
    };
    for (size_t row = 0; row < LENGTH(rows); row++) {
        double angle = rows[row].angle * radians;
        assert_true(fabs(cone_slope(CONE_FIT_OUTER, angle) - rows[row].outer) < 5.1e-6);
        assert_true(fabs(cone_slope(CONE_FIT_INNER, angle) - rows[row].inner) < 5.1e-6);
        assert_true(fabs(cone_slope(CONE_FIT_PLANE_STRAIN_ASSOCIATED, angle) -
                         rows[row].associated) < 5.1e-6);
        assert_true(fabs(cone_slope(CONE_FIT_PLANE_STRAIN, angle) - rows[row].plane) < 5.1e-6);
    }
    assert_true(fabs(cone_slope_limit(CONE_FIT_OUTER) - sqrt(2.0 / 3.0)) < 1e-15);
}

/* The apex of every fit is Mohr-Coulomb's, I1 = 3 c cot(phi); angles come back from slopes. */
static void test_apex_and_inverse(void **context)
{
    (void)context;
    for (enum cone_fit fit = CONE_FIT_OUTER; fit <= CONE_FIT_PLANE_STRAIN_ASSOCIATED; fit++) {
        for (int degrees = 1; degrees < 85; degrees += 3) {
            double angle = degrees * radians;
            double slope = cone_slope(fit, angle);
            double apex = cone_strength(fit, angle, 7.0) / slope;
            assert_true(slope < cone_slope_limit(fit));
            assert_true(fabs(apex - 21.0 / tan(angle)) < 1e-12 * apex);
            assert_true(fabs(cone_angle(fit, slope) - angle) < 1e-12);
        }
    }
}

/* Strength and slopes that a set of parameters comes to. */
static struct cap prepare(const struct setting *own, size_t count)
{
    struct setting settings[12] = {
        {"density", 2000.0}, {"bulk_modulus", 5e6}, {"shear_modulus", 3e6}};
    struct fixture fixture;
    memcpy(&settings[3], own, count * sizeof *own);
    fixture_init(&fixture, "drucker_prager_cap", settings, count + 3);
    struct cap cap = *(struct cap *)fixture.constants;
    fixture_release(&fixture);
    return cap;
}

static void assert_cap(const struct setting *own, size_t count, double slope, double flow_slope,
                       double strength)
{
    struct cap cap = prepare(own, count);
    assert_true(fabs(cap.cone.slope - slope) < 1e-12);
    assert_true(fabs(cap.cone.flow_slope - flow_slope) < 1e-12);
    assert_true(fabs(cap.cone.strength - strength) < 1e-9 * strength);
    /* the circle about the origin touches the cone at the tangent point */
    double radius = hypot(cap.tangent_invariant, cap.tangent_norm);
    assert_true(fabs(radius - cap.radius) < 1e-12 * radius);
    assert_true(fabs(cap.tangent_norm + slope * cap.tangent_invariant - strength) <
                1e-9 * strength);
}

static void test_alternatives(void **context)
{
    (void)context;
    double angle = 25.0 * radians;
    double outer = cone_slope(CONE_FIT_OUTER, angle);
    double inner = cone_slope(CONE_FIT_INNER, angle);
    double plane = cone_slope(CONE_FIT_PLANE_STRAIN, angle);
    double associated = cone_slope(CONE_FIT_PLANE_STRAIN_ASSOCIATED, angle);
    const struct setting by_angle[] = {{"friction_angle", 25.0}, {"cohesion", 100.0}};
    assert_cap(by_angle, 2, outer, 0.0, cone_strength(CONE_FIT_OUTER, angle, 100.0));
    const struct setting by_slope[] = {
        {"cone_slope", outer}, {"cohesion", 100.0}, {"flow_ratio", 0.5}};
    assert_cap(by_slope, 3, outer, 0.5 * outer, cone_strength(CONE_FIT_OUTER, angle, 100.0));
    const struct setting by_strength[] = {
        {"cone_slope", outer}, {"cone_strength", 40.0}, {"flow_slope", -0.01}};
    assert_cap(by_strength, 3, outer, -0.01, 40.0);
    const struct setting extension[] = {
        {"friction_angle", 25.0}, {"cohesion", 100.0}, {"dilation_angle", 10.0}, {"cone_fit", 1.0}};
    assert_cap(extension, 4, inner, cone_slope(CONE_FIT_INNER, 10.0 * radians),
               cone_strength(CONE_FIT_INNER, angle, 100.0));
    const struct setting no_dilation[] = {
        {"friction_angle", 25.0}, {"cohesion", 100.0}, {"cone_fit", 2.0}};
    assert_cap(no_dilation, 3, plane, 0.0, cone_strength(CONE_FIT_PLANE_STRAIN, angle, 100.0));
    const struct setting same[] = {
        {"friction_angle", 25.0}, {"cohesion", 100.0}, {"dilation_angle", 25.0}, {"cone_fit", 2.0}};
    assert_cap(same, 4, associated, associated,
               cone_strength(CONE_FIT_PLANE_STRAIN_ASSOCIATED, angle, 100.0));
    const struct setting ratio[] = {
        {"friction_angle", 25.0}, {"cohesion", 100.0}, {"flow_ratio", 1.0}, {"cone_fit", 2.0}};
    assert_cap(ratio, 4, associated, associated,
               cone_strength(CONE_FIT_PLANE_STRAIN_ASSOCIATED, angle, 100.0));
}

/* The angle that a triaxial compression test measures, for the K0 rules. */
static void test_initial_friction_angle(void **context)
{
    (void)context;
    const struct setting settings[] = {{"density", 2000.0},    {"bulk_modulus", 5e6},
                                       {"shear_modulus", 3e6}, {"friction_angle", 33.0},
                                       {"cohesion", 1e3},      {"cone_fit", 0.0}};
    struct fixture fixture;
    fixture_init(&fixture, "drucker_prager_cap", settings, LENGTH(settings));
    double angle = material_initial_friction_angle_deg(fixture.material, fixture.values);
    assert_true(fabs(angle - 33.0) < 1e-10);
    fixture_release(&fixture);
    const struct setting mobilised[] = {{"density", 2000.0},    {"bulk_modulus", 5e6},
                                        {"shear_modulus", 3e6}, {"friction.a0", 35.0},
                                        {"friction.a4", 10.0},  {"friction.a1", 9.0}};
    fixture_init(&fixture, "matsuoka_nakai", mobilised, LENGTH(mobilised));
    angle = material_initial_friction_angle_deg(fixture.material, fixture.values);
    assert_true(fabs(angle - 25.0) < 1e-12);
    fixture_release(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slopes),
        cmocka_unit_test(test_apex_and_inverse),
        cmocka_unit_test(test_alternatives),
        cmocka_unit_test(test_initial_friction_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* The friction law, and the returns of both models that use it from random trials. */
#include "material_fixture.h"

#include "materials/mobilised.h"
#include "math/eigen.h"

enum { SLOTS = 25600 };
static const double degrees = 180.0 / M_PI;

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g instead of %.12g", value, expected);
}

struct angles {
    double friction, dilation; /* [deg] */
};

/* The angles in force after a plastic strain `lambda` under I1. */
static struct angles find_angles(const struct fixture *fixture, double lambda, double first)
{
    struct slots slots;
    struct mobilised_angles angles;
    slots_init(&slots, 8, 6);
    slots.history[MOBILISED_STATE_LAMBDA][0] = lambda;
    slots.history[MOBILISED_STATE_INVARIANT][0] = first;
    mobilised_angles_at_start(fixture->constants, &slots.batch, 0, 8, &angles);
    slots_release(&slots);
    return (struct angles){atan(angles.tangent[0]) * degrees,
                           atan(angles.flow_tangent[0]) * degrees};
}

static void init_law(struct fixture *fixture, const double constants[6], double scale)
{
    const struct setting settings[] = {
        {"density", 2000.0},           {"bulk_modulus", 5e6},
        {"shear_modulus", 3e6},        {"friction.a0", constants[0]},
        {"friction.a1", constants[1]}, {"friction.a2", constants[2]},
        {"friction.a3", constants[3]}, {"friction.a4", constants[4]},
        {"friction.a5", constants[5]}, {"friction.strain_scale", scale}};
    fixture_init(fixture, "matsuoka_nakai", settings, LENGTH(settings));
}

/* The three sets of Mast 2013, table 3.5 (a2 there in 1/kPa), peaks and limits computed by hand. */
static void test_friction_law(void **context)
{
    (void)context;
    static const double sets[3][6] = {{20, 7750, 3.33e-7, 150, 20, 300},
                                      {20, 2000, 1.67e-8, 100, 20, 100},
                                      {20, 0, 0, 70, 20, 50}};
    struct fixture fixture;
    init_law(&fixture, sets[0], 1.0);
    assert_near(find_angles(&fixture, 0.0, -450e3).friction, 2.78, 0.005);
    assert_near(find_angles(&fixture, 0.0, -450e3).dilation, 2.78, 0.005); /* phi_cs = 0 */
    double lambda = 1.0 / 150.0 + 20.0 / 7750.0;
    assert_near(lambda, 0.00925, 5e-6);
    struct angles peak = find_angles(&fixture, lambda, -450e3);
    assert_near(peak.friction, 31.1, 0.05);
    assert_true(find_angles(&fixture, 0.99 * lambda, -450e3).friction < peak.friction);
    assert_true(find_angles(&fixture, 1.01 * lambda, -450e3).friction < peak.friction);
    double critical = 20.0 - 20.0 * exp(-300.0 * lambda);
    double dilation = atan(tan(peak.friction / degrees) - tan(critical / degrees)) * degrees;
    assert_near(peak.dilation, dilation, 1e-12);
    assert_near(find_angles(&fixture, 0.05, -450e3).friction, 20.2, 0.05);
    assert_near(find_angles(&fixture, 1.0, -450e3).dilation, 0.0, 1e-10);
    fixture_release(&fixture);

    init_law(&fixture, sets[1], 1.0);
    assert_near(find_angles(&fixture, 0.020, 0.0).friction, 22.7, 0.05);
    fixture_release(&fixture);
    init_law(&fixture, sets[2], 1.0);
    for (int percent = 0; percent < 20; percent++)
        assert_true(find_angles(&fixture, 0.01 * (percent + 1), 0.0).friction >
                    find_angles(&fixture, 0.01 * percent, 0.0).friction);
    fixture_release(&fixture);
}

/* Constants for percent: the same angles at a hundredth of the strain. */
static void test_strain_scale(void **context)
{
    (void)context;
    static const double set[6] = {35, 9, 0, 0.3, 10, 0.2};
    struct fixture plain;
    struct fixture percent;
    init_law(&plain, set, 1.0);
    init_law(&percent, set, 100.0);
    for (int lambda = 0; lambda < 8; lambda++) {
        struct angles a = find_angles(&plain, lambda, 0.0);
        struct angles b = find_angles(&percent, lambda / 100.0, 0.0);
        assert_near(a.friction, b.friction, 1e-11);
        assert_near(a.dilation, b.dilation, 1e-11);
    }
    fixture_release(&plain);
    fixture_release(&percent);
}

/* Angles never leave 0 ... 89 degrees, whatever the constants do. */
static void test_angles_are_limited(void **context)
{
    (void)context;
    static const double set[6] = {30, 5000, 0, 1, 60, 10};
    struct fixture fixture;
    init_law(&fixture, set, 1.0);
    assert_near(find_angles(&fixture, 0.0, 0.0).friction, 0.0, 0.0);
    assert_near(find_angles(&fixture, 0.0, 0.0).dilation, 0.0, 0.0);
    assert_near(find_angles(&fixture, 0.5, 0.0).friction, 89.0, 1e-10);
    fixture_release(&fixture);
}

/* What adds up to lambda: all of the plastic strain, its spherical or its deviatoric part. */
static void test_strain_measure(void **context)
{
    (void)context;
    double lambda[3];
    for (int measure = 0; measure < 3; measure++) {
        const struct setting settings[] = {
            {"density", 2000.0},   {"bulk_modulus", 5e6},    {"shear_modulus", 3e6},
            {"friction.a0", 30.0}, {"dilation_angle", 10.0}, {"friction.strain_measure", measure}};
        struct fixture fixture;
        struct slots slots;
        fixture_init(&fixture, "drucker_prager_mobilised", settings, LENGTH(settings));
        slots_init(&slots, 8, 6);
        for (int component = 0; component < 3; component++)
            slots.batch.strain[component][0] = -1e-3;
        slots.batch.strain[3][0] = 4e-3;
        fixture.material->update_stress(fixture.constants, &slots.batch);
        lambda[measure] = slots.history[MOBILISED_STATE_LAMBDA][0];
        assert_true(lambda[measure] > 0.0);
        assert_true(measure != 0 || lambda[0] == slots.batch.plastic_strain[0]);
        slots_release(&slots);
        fixture_release(&fixture);
    }
    double sine = sin(10.0 / degrees);
    double flow_slope = sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
    assert_near(hypot(lambda[1], lambda[2]), lambda[0], 1e-15);
    assert_near(lambda[1], sqrt(3.0) * flow_slope * lambda[2], 1e-14);
}

static void init_constant(struct fixture *fixture, const char *model, double friction,
                          double dilation, double cohesion)
{
    const struct setting settings[] = {{"density", 2000.0},          {"bulk_modulus", 8e6},
                                       {"shear_modulus", 3.7e6},     {"friction_angle", friction},
                                       {"dilation_angle", dilation}, {"cohesion", cohesion}};
    fixture_init(fixture, model, settings, LENGTH(settings));
}

static void fill(struct slots *slots, uint64_t *state)
{
    for (size_t slot = 0; slot < slots->batch.count; slot++) {
        double size = 1e-3 * pow(10.0, 1.5 * random_value(state));
        double spherical = 3.0 * random_value(state) - 1.0;
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            slots->batch.strain[component][slot] =
                size * (random_value(state) + (component < 3 ? spherical : 0.0));
    }
}

/* Yield functions over the size of the stress, of principal stresses beyond the apex. */
static double drucker_prager(const double s[3], double friction)
{
    double sine = sin(friction / degrees);
    double slope = sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
    double mean = (s[0] + s[1] + s[2]) / 3.0;
    double norm = sqrt((s[0] - mean) * (s[0] - mean) + (s[1] - mean) * (s[1] - mean) +
                       (s[2] - mean) * (s[2] - mean));
    return (norm + slope * 3.0 * mean) / (norm + 3.0 * fabs(mean));
}

static double matsuoka_nakai(const double s[3], double friction)
{
    double tangent = tan(friction / degrees);
    double kappa = 9.0 + 8.0 * tangent * tangent;
    double first = s[0] + s[1] + s[2];
    double second = s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
    double size = fabs(s[0]) + fabs(s[1]) + fabs(s[2]);
    return (kappa * s[0] * s[1] * s[2] - first * second) / (size * size * size);
}

static void check_slot(const struct slots *slots, size_t slot, double apex, double friction,
                       double (*yield)(const double s[3], double friction), size_t *apex_count,
                       size_t *plastic_count)
{
    double *const *stress = slots->batch.stress;
    struct sym3 tensor = {stress[0][slot], stress[1][slot], stress[2][slot],
                          stress[3][slot], stress[4][slot], stress[5][slot]};
    struct mat3 vectors;
    double s[3];
    sym3_eigen(sym3_add_diagonal(tensor, -apex), s, &vectors);
    double scale = apex + sym3_norm(tensor);
    /* a Drucker-Prager cone outside Mohr-Coulomb lets single principal stresses be tensile */
    double largest =
        yield == matsuoka_nakai ? fmax(s[0], fmax(s[1], s[2])) : (s[0] + s[1] + s[2]) / 3.0;
    assert_true(slots->batch.dissipation[slot] >= 0.0);
    assert_true(largest <= 1e-10 * (scale + 1e3)); /* tension cut-off */
    if (slots->batch.plastic_strain[slot] > 0.0)
        *plastic_count += 1;
    if (largest > -1e-9 * scale || sym3_norm(tensor) < 1e-6) {
        *apex_count += 1;
        assert_true(sym3_norm(sym3_add_diagonal(tensor, -apex)) < 1e-9 * (scale + 1e3));
        return;
    }
    double value = yield(s, friction);
    assert_true(value < 1e-11);
    /* near the apex the shifted stress has lost digits to the trial */
    if (slots->batch.plastic_strain[slot] > 0.0 && largest < -1e-3 * scale)
        assert_true(fabs(value) < 1e-10);
}

static void check_return(const char *model, double friction, double dilation, double cohesion,
                         double (*yield)(const double s[3], double friction), uint64_t *state)
{
    struct fixture fixture;
    struct slots slots;
    size_t apex_count = 0;
    size_t plastic_count = 0;
    double apex = cohesion / tan(friction / degrees);
    init_constant(&fixture, model, friction, dilation, cohesion);
    slots_init(&slots, SLOTS, 6);
    fill(&slots, state);
    fixture.material->update_stress(fixture.constants, &slots.batch);
    for (size_t slot = 0; slot < SLOTS; slot++)
        check_slot(&slots, slot, apex, friction, yield, &apex_count, &plastic_count);
    assert_true(apex_count > 500);
    assert_true(plastic_count > apex_count + 500);
    assert_true(plastic_count < SLOTS - 500);

    /* a second return finds nothing to do */
    double(*kept)[SLOTS] = calloc(SYM3_COMPONENTS, sizeof *kept);
    assert_non_null(kept);
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        memcpy(kept[component], slots.batch.stress[component], sizeof *kept);
    fixture.material->update_stress(fixture.constants, &slots.batch);
    for (size_t slot = 0; slot < SLOTS; slot++) {
        for (int component = 0; component < SYM3_COMPONENTS; component++) {
            double scale = 1e3 + fabs(slots_trace(slots.batch.stress, slot, 6));
            double change = slots.batch.stress[component][slot] - kept[component][slot];
            assert_true(fabs(change) < 1e-10 * scale);
        }
    }
    free(kept);
    slots_release(&slots);
    fixture_release(&fixture);
}

static void test_returns(void **context)
{
    (void)context;
    static const double cases[][3] = {{30, 0, 0},  {20, 10, 500}, {45, 45, 1e3},
                                      {5, 0, 2e3}, {60, 20, 0},   {35, -10, 0}};
    uint64_t state = 5;
    for (size_t index = 0; index < LENGTH(cases); index++) {
        const double *c = cases[index];
        check_return("drucker_prager_mobilised", c[0], c[1], c[2], drucker_prager, &state);
        check_return("matsuoka_nakai", c[0], c[1], c[2], matsuoka_nakai, &state);
    }
}

/* A dilation angle above the friction in force would let plastic flow under pressure give energy:
 * it is cut to associated flow, where the work is exactly zero without cohesion. */
static void test_dilation_is_limited_by_friction(void **context)
{
    (void)context;
    const char *const models[] = {"drucker_prager_mobilised", "matsuoka_nakai"};
    const struct setting settings[] = {{"density", 2000.0},    {"bulk_modulus", 5e6},
                                       {"shear_modulus", 3e6}, {"friction.a0", 30.0},
                                       {"friction.a4", 20.0},  {"dilation_angle", 25.0}};
    for (size_t model = 0; model < LENGTH(models); model++) {
        struct fixture fixture;
        struct slots slots;
        double trial[SYM3_COMPONENTS] = {-1e-2, -1.2e-2, -1.1e-2, 1e-2, 0, 0};
        double work = 0.0;
        fixture_init(&fixture, models[model], settings, LENGTH(settings));
        slots_init(&slots, 8, 6);
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            slots.batch.strain[component][0] = trial[component];
        fixture.material->update_stress(fixture.constants, &slots.batch);
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            work += (component < 3 ? 1.0 : 2.0) * slots.batch.stress[component][0] *
                    (trial[component] - slots.batch.strain[component][0]);
        double pressure = -slots_trace(slots.batch.stress, 0, 6) / 3.0;
        assert_true(slots.batch.plastic_strain[0] > 1e-3 && pressure > 1e4);
        assert_true(fabs(work) < 1e-12 * pressure);
        slots_release(&slots);
        fixture_release(&fixture);
    }
}

/* Matsuoka-Nakai meets Mohr-Coulomb in triaxial compression and extension. */
static void test_matsuoka_nakai_corners(void **context)
{
    (void)context;
    for (int friction = 1; friction < 85; friction += 4) {
        double ratio = (1.0 + sin(friction / degrees)) / (1.0 - sin(friction / degrees));
        struct fixture fixture;
        struct slots slots;
        init_constant(&fixture, "matsuoka_nakai", friction, 0.0, 0.0);
        slots_init(&slots, 8, 6);
        for (int extension = 0; extension < 2; extension++) {
            double e = extension ? -1e-2 : 1e-2;
            slots.batch.strain[0][extension] = -2e-3 + e;
            slots.batch.strain[1][extension] = -2e-3 + e;
            slots.batch.strain[2][extension] = -2e-3 - 2.0 * e;
        }
        fixture.material->update_stress(fixture.constants, &slots.batch);
        double *const *stress = slots.batch.stress;
        assert_near(stress[2][0] / stress[0][0], ratio, 1e-11 * ratio);
        assert_near(stress[0][1] / stress[2][1], ratio, 1e-11 * ratio);
        slots_release(&slots);
        fixture_release(&fixture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_friction_law),
        cmocka_unit_test(test_strain_scale),
        cmocka_unit_test(test_angles_are_limited),
        cmocka_unit_test(test_strain_measure),
        cmocka_unit_test(test_returns),
        cmocka_unit_test(test_matsuoka_nakai_corners),
        cmocka_unit_test(test_dilation_is_limited_by_friction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

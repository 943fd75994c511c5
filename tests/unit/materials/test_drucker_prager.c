/* SPDX-License-Identifier: Apache-2.0 */
/* The cone that hardens: random trials against the equations of backward Euler, the return to the
 * apex that moves, the region where the cut-off is not active, contraction, and back stress. That
 * returns are on the surface is left to the random trials of all models. */
#include "material_fixture.h"

#include "materials/cone.h"

static const double bulk = 8e6, shear = 3.7e6;
static const double root = 0.816496580927726; /* sqrt(2/3) */

struct law { /* as the test sets it */
    double slope, flow_slope, strength, isotropic, kinematic;
};

static void init(struct fixture *fixture, const struct law *law)
{
    const struct setting settings[] = {{"density", 2000.0},
                                       {"bulk_modulus", bulk},
                                       {"shear_modulus", shear},
                                       {"cone_slope", law->slope},
                                       {"flow_slope", law->flow_slope},
                                       {"cone_strength", law->strength},
                                       {"isotropic_hardening", law->isotropic},
                                       {"kinematic_hardening", law->kinematic}};
    fixture_init(fixture, "drucker_prager", settings, LENGTH(settings));
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g instead of %.17g +- %.2g", value, expected, tolerance);
}

struct step {                           /* a trial and where it returned to */
    struct sym3 trial, elastic, stress; /* strains, stress [Pa] */
    struct sym3 back[2];                /* back strain before and after */
    double isotropic[2], plastic_strain, dissipation;
};

/* One update of a state with this history. */
static void run(const struct fixture *fixture, struct step *step)
{
    struct slots slots;
    slots_init(&slots, 8, SYM3_COMPONENTS);
    slots_set(slots.batch.strain, 0, step->trial);
    slots.history[0][0] = step->isotropic[0];
    slots_set(slots.history + 1, 0, step->back[0]);
    fixture->material->update_stress(fixture->constants, &slots.batch);
    step->elastic = slots_get(slots.batch.strain, 0);
    step->stress = slots_get(slots.batch.stress, 0);
    step->back[1] = slots_get(slots.history + 1, 0);
    step->isotropic[1] = slots.history[0][0];
    step->plastic_strain = slots.batch.plastic_strain[0];
    step->dissipation = slots.batch.dissipation[0];
    slots_release(&slots);
}

static struct sym3 relative(const struct law *law, struct sym3 deviator, struct sym3 back)
{
    return sym3_add_scaled(deviator, -2.0 / 3.0 * law->kinematic, back);
}

enum region { ELASTIC, CONE, APEX, STOP, REGION_COUNT };

/* The plastic strain is along eta and the trace, in the ratio of the flow of the region; history
 * grows with it. */
static enum region check_rules(const struct law *law, const struct step *step)
{
    struct sym3 plastic = sym3_add_scaled(step->trial, -1.0, step->elastic);
    double size = sym3_norm(step->trial) + 1e-9;
    double spherical = sym3_trace(plastic) / 3.0;
    struct sym3 deviatoric = sym3_deviator(plastic);
    double multiplier = sym3_norm(deviatoric);
    struct sym3 trial_deviator = sym3_scale(2.0 * shear, sym3_deviator(step->trial));
    struct sym3 eta = relative(law, trial_deviator, step->back[0]);
    double norm = sym3_norm(eta);
    struct sym3 left = relative(law, sym3_deviator(step->stress), step->back[1]);
    double first = sym3_trace(step->stress);
    double strength = law->strength + root * law->isotropic * step->isotropic[1];
    assert_near(step->plastic_strain, sym3_norm(plastic), 1e-13 * size);
    if (step->plastic_strain == 0.0)
        return ELASTIC;
    struct sym3 across = sym3_add_scaled(deviatoric, -multiplier / (norm > 0 ? norm : 1), eta);
    assert_near(sym3_norm(across), 0.0, 1e-12 * size);
    assert_near(step->isotropic[1] - step->isotropic[0], root * multiplier, 1e-13 * size);
    struct sym3 growth = sym3_add_scaled(step->back[1], -1.0, step->back[0]);
    if (law->kinematic > 0.0)
        assert_near(sym3_norm(sym3_add_scaled(growth, -1.0, deviatoric)), 0.0, 1e-12 * size);
    double work = sym3_norm(left) * multiplier + first * spherical;
    assert_near(step->dissipation, work, 1e-12 * size * size * bulk);
    if (sym3_norm(left) < 1e-9 * size * shear) {
        /* both multipliers: spherical = rho_G dg1 + dg2; contraction may end at an apex at I1 = 0
         */
        double lowest = strength > 0.0 ? fmax(law->flow_slope, 0.0) : law->flow_slope;
        assert_near(first, strength / law->slope, 1e-9 * size * bulk);
        assert_true(spherical - lowest * multiplier >= -1e-12 * size);
        return APEX;
    }
    if (law->flow_slope < 0.0 && first >= -1e-9 * size * bulk) {
        /* between contraction and none, and nothing but that under tension */
        assert_true(spherical <= 1e-12 * size);
        assert_true(spherical >= law->flow_slope * multiplier - 1e-12 * size);
        assert_true(first <= 1e-9 * size * bulk || fabs(spherical) < 1e-12 * size);
        return STOP;
    }
    assert_near(spherical, law->flow_slope * multiplier, 1e-12 * size);
    return CONE;
}

static struct sym3 random_tensor(double size, double spherical, uint64_t *state)
{
    struct sym3 tensor = {random_value(state), random_value(state), random_value(state),
                          random_value(state), random_value(state), random_value(state)};
    return sym3_scale(size, sym3_add_diagonal(tensor, spherical));
}

static void test_rules(void **context)
{
    (void)context;
    static const struct law laws[] = {
        {0.3, 0.1, 2e3, 0, 0},   {0.3, 0.0, 0, 0, 0},        {0.25, 0.25, 1e3, 4e5, 6e5},
        {0.4, 0.2, 1e3, 3e7, 0}, {0.3, -0.1, 2e3, 2e5, 4e5}, {0.35, -0.15, 0, 0, 3e5},
    };
    uint64_t state = 3;
    for (size_t index = 0; index < LENGTH(laws); index++) {
        const struct law *law = &laws[index];
        struct fixture fixture;
        size_t regions[REGION_COUNT] = {0};
        init(&fixture, law);
        for (int trial = 0; trial < 4000; trial++) {
            struct step step = {.isotropic = {1e-3 * fabs(random_value(&state))}};
            double size = 1e-3 * pow(10.0, 1.5 * random_value(&state));
            step.trial = random_tensor(size, 2.0 * random_value(&state), &state);
            step.back[0] = sym3_deviator(random_tensor(1e-3, 0.0, &state));
            run(&fixture, &step);
            regions[check_rules(law, &step)]++;
        }
        assert_true(regions[CONE] > 200 && regions[APEX] > 200);
        assert_true((regions[STOP] > 200) == (law->flow_slope < 0.0 && law->strength > 0.0));
        fixture_release(&fixture);
    }
}

/* A pull beyond the apex of a cone that hardens: without 2 k / (3 rho) in J21 the return would miss
 * the apex, which has moved by k a_iso, and leave a deviator. */
static void test_apex_moves(void **context)
{
    (void)context;
    const struct law law = {0.3, 0.1, 2e3, 5e6, 0};
    struct fixture fixture;
    struct step step = {.trial = {8e-4, 9e-4, 6e-4, 2e-4, 0, 0}};
    init(&fixture, &law);
    run(&fixture, &step);
    double norm = 2.0 * shear * sym3_norm(sym3_deviator(step.trial));
    double isotropic = root * norm / (2.0 * shear);
    double apex = (law.strength + root * law.isotropic * isotropic) / law.slope;
    assert_near(step.isotropic[1], isotropic, 1e-15);
    assert_near(sym3_trace(step.stress), apex, 1e-11 * apex);
    assert_near(sym3_norm(sym3_deviator(step.stress)), 0.0, 1e-11 * apex);

    /* the multipliers of the system without the term */
    double first = 3.0 * bulk * sym3_trace(step.trial);
    double a11 = 2.0 * shear + 2.0 / 3.0 * law.isotropic + 9.0 * bulk * law.slope * law.flow_slope;
    double a12 = 9.0 * bulk * law.slope;
    double a21 = 9.0 * bulk * law.flow_slope;
    double a22 = 9.0 * bulk;
    double f1 = norm + law.slope * first - law.strength;
    double f2 = first - law.strength / law.slope;
    double multiplier = (a22 * f1 - a12 * f2) / (a11 * a22 - a12 * a21);
    assert_true(fabs(norm - 2.0 * shear * multiplier) > 0.1 * norm);
    fixture_release(&fixture);
}

/* Beyond the apex in I1 but with so much shear that the cut-off would need a negative multiplier:
 * the cone alone. */
static void test_cut_off_is_dropped(void **context)
{
    (void)context;
    const struct law law = {0.3, 0.3, 2e3, 0, 0};
    struct fixture fixture;
    struct step step = {.trial = {.xx = 1.2e-4, .yy = 1.2e-4, .zz = 1.2e-4, .xy = 5e-3}};
    init(&fixture, &law);
    run(&fixture, &step);
    double apex = law.strength / law.slope;
    assert_true(3.0 * bulk * sym3_trace(step.trial) > apex);
    assert_true(sym3_trace(step.stress) < apex);
    double norm = sym3_norm(sym3_deviator(step.stress));
    assert_true(norm > 0.1 * law.strength);
    assert_near(norm + law.slope * sym3_trace(step.stress), law.strength, 1e-9 * law.strength);
    fixture_release(&fixture);
}

/* Shear forth and back: with kinematic hardening yielding begins 2 mu before, with isotropic
 * hardening as late as it ended. */
static void test_reversal(void **context)
{
    (void)context;
    for (int kinematic = 0; kinematic < 2; kinematic++) {
        const struct law law = {0.0, 0.0, 2e3, kinematic ? 0.0 : 6e5, kinematic ? 6e5 : 0.0};
        struct fixture fixture;
        struct step step = {.trial = {.xy = 5e-3}};
        init(&fixture, &law);
        run(&fixture, &step);
        double top = sym3_norm(step.stress);
        assert_true(top > 1.5 * law.strength);
        double width = kinematic ? 2.0 * law.strength : 2.0 * top; /* of |s| between both yields */
        for (int beyond = 0; beyond < 2; beyond++) {
            struct step back = {.isotropic = {step.isotropic[1]}, .back = {step.back[1]}};
            double size = top - width * (beyond ? 1.001 : 0.999);
            back.trial.xy = size / sqrt(2.0) / (2.0 * shear);
            run(&fixture, &back);
            assert_int_equal(back.plastic_strain > 0.0, beyond);
        }
        fixture_release(&fixture);
    }
}

/* Without cohesion unless it is given; its alternatives come to the same cone. */
static void test_parameters(void **context)
{
    (void)context;
    double angle = 30.0 * M_PI / 180.0;
    double slope = cone_slope(CONE_FIT_INNER, angle);
    double strength = cone_strength(CONE_FIT_INNER, angle, 1e3);
    const struct setting by_angle[] = {{"density", 2000.0},         {"bulk_modulus", bulk},
                                       {"shear_modulus", shear},    {"friction_angle", 30.0},
                                       {"cohesion", 1e3},           {"flow_ratio", 0.5},
                                       {"cone_fit", CONE_FIT_INNER}};
    const struct law by_slope = {slope, 0.5 * slope, strength, 0, 0};
    struct fixture first;
    struct fixture second;
    struct step one = {.trial = {-1e-3, 0, -2e-3, 3e-3, 1e-3, 0}};
    struct step two = one;
    fixture_init(&first, "drucker_prager", by_angle, LENGTH(by_angle));
    init(&second, &by_slope);
    run(&first, &one);
    run(&second, &two);
    assert_true(one.plastic_strain > 0.0);
    assert_near(sym3_norm(sym3_add_scaled(one.stress, -1.0, two.stress)), 0.0, 1e-8);
    assert_near(material_initial_friction_angle_deg(first.material, first.values),
                cone_angle(CONE_FIT_OUTER, slope) * 180.0 / M_PI, 1e-12);
    fixture_release(&first);
    fixture_release(&second);

    const struct setting sand[] = {{"density", 2000.0},
                                   {"bulk_modulus", bulk},
                                   {"shear_modulus", shear},
                                   {"friction_angle", 30.0}};
    struct step pull = {.trial = {.xx = 1e-4, .yy = 1e-4, .xy = 1e-5}};
    fixture_init(&first, "drucker_prager", sand, LENGTH(sand));
    run(&first, &pull);
    assert_near(sym3_norm(pull.stress), 0.0, 1e-9);
    fixture_release(&first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rules),
        cmocka_unit_test(test_apex_moves),
        cmocka_unit_test(test_cut_off_is_dropped),
        cmocka_unit_test(test_reversal),
        cmocka_unit_test(test_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* The return to the capped cone from random trials: on the surface, along the flow of the surface
 * that it lies on (between both at the corner), nothing left for a second return. */
#include "material_fixture.h"

#include "materials/cap_return.h"

enum { SLOTS = 25600, REGIONS = 4 };
enum region { ELASTIC, CONE, CORNER, CIRCLE };

static void init(struct fixture *fixture, double friction, double flow_ratio)
{
    const struct setting settings[] = {{"density", 2000.0},       {"bulk_modulus", 8e6},
                                       {"shear_modulus", 3.7e6},  {"friction_angle", friction},
                                       {"cone_strength", 1000.0}, {"flow_ratio", flow_ratio}};
    fixture_init(fixture, "drucker_prager_cap", settings, LENGTH(settings));
}

/* Trials from far inside to a thousand times the strength, every ratio of shear and pressure. */
static void fill(struct slots *slots, double *const trial[SYM3_COMPONENTS], uint64_t *state)
{
    for (size_t slot = 0; slot < slots->batch.count; slot++) {
        double size = 1e-5 * pow(10.0, 2.0 + 2.5 * random_value(state));
        double spherical = 2.0 * random_value(state);
        for (int component = 0; component < SYM3_COMPONENTS; component++) {
            double value = random_value(state) + (component < 3 ? spherical : 0.0);
            slots->batch.strain[component][slot] = trial[component][slot] = size * value;
        }
    }
}

static enum region find_region(const struct cap *cap, double first, double plastic)
{
    if (plastic == 0.0)
        return ELASTIC;
    if (fabs(first - cap->tangent_invariant) < 1e-9 * cap->radius)
        return CORNER;
    return first < cap->tangent_invariant ? CONE : CIRCLE;
}

/* Yield function over the size of the stress. */
static double yield(const struct cap *cap, double first, double norm)
{
    double scale = cap->cone.strength + fabs(first);
    return first <= cap->tangent_invariant
               ? (norm + cap->cone.slope * first - cap->cone.strength) / scale
               : (hypot(norm, first) - cap->radius) / scale;
}

/* How far the plastic strain is from the flow rule: (deviatoric norm, trace/3) against (1, rho_G)
 * on the cone, (|s|, I1) on the circle, and between the two at the corner. */
static bool follows_flow(const struct cap *cap, enum region region, double deviatoric,
                         double spherical, double first, double norm)
{
    double size = hypot(deviatoric, spherical);
    double across_cone = spherical - cap->cone.flow_slope * deviatoric;
    double across_circle = spherical * norm - first * deviatoric;
    if (region == CONE)
        return fabs(across_cone) < 1e-9 * size;
    if (region == CIRCLE)
        return fabs(across_circle) < 1e-9 * size * cap->radius;
    return across_cone > -1e-9 * size && across_circle < 1e-9 * size * cap->radius;
}

static void check_slot(const struct cap *cap, const struct slots *slots,
                       double *const trial[SYM3_COMPONENTS], size_t slot, size_t *regions)
{
    const struct material_batch *batch = &slots->batch;
    double first = slots_trace(batch->stress, slot, 6);
    double norm = slots_deviator_norm(batch->stress, slot, 6);
    double plastic = batch->plastic_strain[slot];
    enum region region = find_region(cap, first, plastic);
    double trial_norm = slots_deviator_norm(trial, slot, 6);
    double trial_trace = slots_trace(trial, slot, 6);
    double size = fabs(trial_norm) + fabs(trial_trace);
    double deviatoric = trial_norm - slots_deviator_norm(batch->strain, slot, 6);
    double spherical = (trial_trace - slots_trace(batch->strain, slot, 6)) / 3.0;
    regions[region]++;
    /* cancellation: a trial of 1000 times the strength leaves 1e-13 of the strength */
    assert_true(yield(cap, first, norm) < 1e-12 * (1.0 + size * 1e7 / cap->cone.strength));
    assert_true(batch->dissipation[slot] >= 0.0);
    if (region == ELASTIC)
        return;
    assert_true(fabs(yield(cap, first, norm)) < 1e-12);
    assert_true(fabs(hypot(deviatoric, sqrt(3.0) * spherical) - plastic) < 1e-12 * size);
    assert_true(deviatoric > 0.0 && plastic > 0.0);
    if (plastic > 1e-3 * size) /* else round-off decides on the direction */
        assert_true(follows_flow(cap, region, deviatoric, spherical, first, norm));
    double work = norm * deviatoric + first * spherical;
    assert_true(fabs(work - batch->dissipation[slot]) <
                1e-9 * (fabs(first) + norm) * (deviatoric + fabs(spherical)));
}

/* A second return of the returned state. */
static void check_no_op(const struct fixture *fixture, struct slots *slots, struct slots *kept)
{
    size_t bytes = slots->batch.count * sizeof(double);
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        memcpy(kept->batch.stress[component], slots->batch.stress[component], bytes);
    fixture->material->update_stress(fixture->constants, &slots->batch);
    for (size_t slot = 0; slot < slots->batch.count; slot++) {
        double scale = 1000.0 + fabs(slots_trace(kept->batch.stress, slot, 6));
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            assert_true(fabs(slots->batch.stress[component][slot] -
                             kept->batch.stress[component][slot]) < 1e-11 * scale);
    }
}

static void test_random_trials(void **context)
{
    (void)context;
    static const struct {
        double friction, flow_ratio;
        bool corner; /* the corner of an associated cone is smooth */
    } cases[] = {{20.0, 0.05, true}, {20.0, 0.0, true}, {35.0, 1.0, false}, {25.0, -0.3, true}};
    uint64_t state = 7;
    for (size_t index = 0; index < LENGTH(cases); index++) {
        struct fixture fixture;
        struct slots slots;
        struct slots trial;
        size_t regions[REGIONS] = {0};
        init(&fixture, cases[index].friction, cases[index].flow_ratio);
        slots_init(&slots, SLOTS, 6);
        slots_init(&trial, SLOTS, 6);
        fill(&slots, trial.batch.strain, &state);
        fixture.material->update_stress(fixture.constants, &slots.batch);
        for (size_t slot = 0; slot < SLOTS; slot++)
            check_slot(fixture.constants, &slots, trial.batch.strain, slot, regions);
        check_no_op(&fixture, &slots, &trial);
        assert_true(regions[ELASTIC] > 1000 && regions[CONE] > 1000 && regions[CIRCLE] > 1000);
        assert_true(!cases[index].corner || regions[CORNER] > 500);
        slots_release(&slots);
        slots_release(&trial);
        fixture_release(&fixture);
    }
}

/* Every way out of the elastic region, by hand. */
static void test_regions(void **context)
{
    (void)context;
    struct fixture fixture;
    struct slots slots;
    init(&fixture, 20.0, 0.0);
    const struct cap *cap = fixture.constants;
    slots_init(&slots, 8, 6);
    double *const *strain = slots.batch.strain;
    double elastic_norm = 1.0 / (2.0 * cap->elasticity.shear * sqrt(2.0)); /* of s_xy for |s| = 1 */
    double elastic_first = 1.0 / (9.0 * cap->elasticity.bulk);             /* of e_xx for I1 = 1 */
    const double first[] = {0.0, -5000.0, 20.0, cap->tangent_invariant, 5000.0, 5000.0, 100.0};
    const double norm[] = {1001.0, 5000.0, 1200.0, 1100.0, 0.0, 600.0, 990.0};
    for (size_t slot = 0; slot < LENGTH(first); slot++) {
        for (int component = 0; component < 3; component++)
            strain[component][slot] = first[slot] * elastic_first;
        strain[3][slot] = norm[slot] * elastic_norm;
    }
    fixture.material->update_stress(fixture.constants, &slots.batch);
    static const enum region expected[] = {CONE, CONE, CONE, CORNER, CIRCLE, CIRCLE, CONE};
    for (size_t slot = 0; slot < LENGTH(expected); slot++) {
        double invariant = slots_trace(slots.batch.stress, slot, 6);
        assert_int_equal(find_region(cap, invariant, slots.batch.plastic_strain[slot]),
                         expected[slot]);
    }
    /* pure tension ends on the axis at the radius; without dilation the cone keeps I1 */
    assert_true(fabs(slots_trace(slots.batch.stress, 4, 6) - cap->radius) < 1e-10 * cap->radius);
    assert_true(fabs(slots_trace(slots.batch.stress, 1, 6) + 5000.0) < 1e-9);
    slots_release(&slots);
    fixture_release(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_trials),
        cmocka_unit_test(test_regions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

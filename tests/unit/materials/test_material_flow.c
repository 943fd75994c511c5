/* SPDX-License-Identifier: Apache-2.0 */
/* What a model says about its own update: whether anything flowed, and which outputs it writes. And
 * the return to the circle of the capped cone for nearly incompressible bodies, where it takes more
 * steps than usual. */
#include "material_fixture.h"

#include "materials/cap_return.h"

enum { SLOTS = 72 }; /* a whole chunk and a part of one */
static const double untouched = -7.0;

static void fill(struct slots *slots, const double *size, bool volumetric, uint64_t *state)
{
    for (size_t slot = 0; slot < slots->batch.count; slot++) {
        for (size_t component = 0; component < slots->batch.component_count; component++) {
            bool set = !volumetric || component == 0;
            slots->batch.strain[component][slot] = set ? size[slot] * random_value(state) : 0.0;
            slots->rate[component][slot] = random_value(state);
        }
        slots->batch.plastic_strain[slot] = slots->batch.dissipation[slot] = untouched;
    }
}

/* One update of strains of these sizes; slots that did not flow must keep their strain to the last
 * bit, and the answer must be what happened. Returns it. */
static bool check_update(const struct fixture *fixture, struct slots *slots, const double *size,
                         uint64_t *state)
{
    const struct material *material = fixture->material;
    double trial[SYM3_COMPONENTS][SLOTS];
    bool flowed = false;
    fill(slots, size, material->volumetric, state);
    for (size_t component = 0; component < slots->batch.component_count; component++)
        memcpy(trial[component], slots->batch.strain[component], sizeof trial[component]);
    bool answer = material->update_stress(fixture->constants, &slots->batch);
    for (size_t slot = 0; slot < SLOTS; slot++) {
        double plastic_strain = slots->batch.plastic_strain[slot];
        double dissipation = slots->batch.dissipation[slot];
        bool changed = false;
        for (size_t component = 0; component < slots->batch.component_count; component++)
            changed = changed || memcmp(&trial[component][slot],
                                        &slots->batch.strain[component][slot], sizeof(double)) != 0;
        assert_true(material->plastic ? plastic_strain >= 0.0 : plastic_strain == untouched);
        assert_true(material->dissipates ? dissipation >= 0.0 : dissipation == untouched);
        assert_true(!changed || plastic_strain > 0.0);
        flowed = flowed || plastic_strain > 0.0;
    }
    assert_int_equal(answer, flowed);
    return answer;
}

static void test_answer_is_what_happened(void **context)
{
    (void)context;
    const double inside = 1e-8;
    const double beyond = 3e-3;
    const size_t component_counts[] = {3, 4, 6};
    uint64_t state = 11;
    for (size_t index = 0; index < material_count; index++) {
        for (size_t kind = 0; kind < LENGTH(component_counts); kind++) {
            struct fixture fixture;
            struct slots slots;
            double size[SLOTS];
            fixture_init_sample(&fixture, material_table[index]);
            slots_init(&slots, SLOTS, component_counts[kind]);
            for (size_t slot = 0; slot < SLOTS; slot++)
                size[slot] = inside;
            assert_false(check_update(&fixture, &slots, size, &state));
            for (size_t slot = MATERIAL_CHUNK; slot < SLOTS; slot++)
                size[slot] = beyond;
            assert_int_equal(check_update(&fixture, &slots, size, &state),
                             fixture.material->plastic);
            for (size_t slot = 0; slot < SLOTS; slot++)
                size[slot] = slot % 3 == 0 ? beyond : inside;
            assert_int_equal(check_update(&fixture, &slots, size, &state),
                             fixture.material->plastic);
            slots_release(&slots);
            fixture_release(&fixture);
        }
    }
}

/* Trials that end on the circle: on it, and along its normal in the norm of the stiffness,
 *
 *   (|s|_tr - |s|) / (2 G |s|) = (I1_tr - I1) / (9 K I1),
 *
 * here compared as shares of the trial. */
static void check_circle(double bulk, double shear, uint64_t *state)
{
    enum { TRIALS = 6400 };
    const struct setting settings[] = {{"density", 2000.0},       {"bulk_modulus", bulk},
                                       {"shear_modulus", shear},  {"friction_angle", 20.0},
                                       {"cone_strength", 1000.0}, {"flow_ratio", 0.3}};
    struct fixture fixture;
    struct slots slots;
    struct slots trial;
    size_t circle_count = 0;
    fixture_init(&fixture, "drucker_prager_cap", settings, LENGTH(settings));
    const struct cap *cap = fixture.constants;
    slots_init(&slots, TRIALS, 6);
    slots_init(&trial, TRIALS, 6);
    for (size_t slot = 0; slot < TRIALS; slot++) {
        /* up to a hundred times the radius, any direction */
        double size = cap->radius * pow(10.0, 1.0 + random_value(state));
        double spherical = size * (1.0 + random_value(state)) / (9.0 * bulk);
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            slots.batch.strain[component][slot] = trial.batch.strain[component][slot] =
                size * random_value(state) / (4.0 * shear) + (component < 3 ? spherical : 0.0);
    }
    assert_true(fixture.material->update_stress(fixture.constants, &slots.batch));
    for (size_t slot = 0; slot < TRIALS; slot++) {
        double first = slots_trace(slots.batch.stress, slot, 6);
        double norm = slots_deviator_norm(slots.batch.stress, slot, 6);
        double first_trial = 3.0 * bulk * slots_trace(trial.batch.strain, slot, 6);
        double norm_trial = 2.0 * shear * slots_deviator_norm(trial.batch.strain, slot, 6);
        if (first <= cap->tangent_invariant * (1.0 + 1e-9) || hypot(first_trial, norm_trial) < 2e3)
            continue;
        circle_count++;
        assert_true(fabs(hypot(first, norm) - cap->radius) < 1e-11 * cap->radius);
        double across =
            (norm_trial - norm) * first * 9.0 * bulk - (first_trial - first) * norm * 2.0 * shear;
        assert_true(fabs(across) <
                    1e-9 * (norm_trial * first * 9.0 * bulk + first_trial * norm * 2.0 * shear));
    }
    assert_true(circle_count > TRIALS / 16);
    slots_release(&slots);
    slots_release(&trial);
    fixture_release(&fixture);
}

static void test_circle_of_stiff_bodies(void **context)
{
    (void)context;
    uint64_t state = 5;
    const double ratios[] = {0.05, 0.7, 2.2, 20.0, 200.0, 5000.0}; /* K / G */
    for (size_t index = 0; index < LENGTH(ratios); index++)
        check_circle(ratios[index] * 1e6, 1e6, &state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_answer_is_what_happened),
        cmocka_unit_test(test_circle_of_stiff_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

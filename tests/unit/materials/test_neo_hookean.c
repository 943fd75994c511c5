/* SPDX-License-Identifier: Apache-2.0 */
#include "material_fixture.h"

#include "math/tensor.h"

static const double bulk = 5e6;
static const double shear = 3e6;
static const struct setting settings[] = {
    {"density", 1000.0}, {"bulk_modulus", bulk}, {"shear_modulus", shear}};

/* Stretches l: tau_i = K ln J + G (l_i^2 - mean l^2) J^(-2/3), W = K/2 ln^2 J + G/2 (...). */
static void test_stretches(void **context)
{
    (void)context;
    const double stretches[][3] = {
        {2.5, 0.6, 1.3}, {0.2, 0.2, 0.2}, {1.0, 1.0, 4.0}, {1.001, 0.999, 1.0005}};
    struct fixture fixture;
    struct slots slots;
    double energy[8];
    fixture_init(&fixture, "neo_hookean", settings, LENGTH(settings));
    slots_init(&slots, 8, 3);
    for (size_t slot = 0; slot < LENGTH(stretches); slot++) {
        for (int axis = 0; axis < 3; axis++)
            slots.batch.strain[axis][slot] = log(stretches[slot][axis]);
    }
    fixture.material->update_stress(fixture.constants, &slots.batch);
    fixture.material->strain_energy(fixture.constants, &slots.batch, energy);
    for (size_t slot = 0; slot < LENGTH(stretches); slot++) {
        const double *l = stretches[slot];
        double volume = l[0] * l[1] * l[2];
        double square = l[0] * l[0] + l[1] * l[1] + l[2] * l[2];
        double factor = shear * pow(volume, -2.0 / 3.0);
        for (int axis = 0; axis < 3; axis++) {
            double expected = bulk * log(volume) + factor * (l[axis] * l[axis] - square / 3.0);
            assert_true(fabs(slots.batch.stress[axis][slot] - expected) < 1e-14 * bulk * 100.0);
        }
        double expected =
            0.5 * bulk * log(volume) * log(volume) + 0.5 * (factor * square - 3.0 * shear);
        assert_true(fabs(energy[slot] - expected) < 1e-14 * bulk * 100.0);
    }
    slots_release(&slots);
    fixture_release(&fixture);
}

/* Simple shear gamma: tau_xy = G gamma whatever gamma is, tau_xx - tau_yy = G gamma^2. */
static void test_simple_shear(void **context)
{
    (void)context;
    const double zero[SYM3_COMPONENTS] = {0};
    const struct material_point_segment path = {.gradient_given = true,
                                                .gradient = {1, 2, 0, 0, 1, 0, 0, 0, 1},
                                                .duration = 1.0,
                                                .step_count = 20};
    struct fixture fixture;
    struct record record;
    fixture_init(&fixture, "neo_hookean", settings, LENGTH(settings));
    record_run(&record, &fixture, true, zero, &path, 1);
    const struct material_point_step *end = &record.steps[record.count - 1];
    assert_true(fabs(end->stress[3] - 2.0 * shear) < 1e-10 * shear);
    assert_true(fabs(end->stress[0] - end->stress[1] - 4.0 * shear) < 1e-10 * shear);
    assert_true(fabs(end->p) < 1e-10 * shear);
    assert_true(fabs(end->strain_energy - 2.0 * shear) < 1e-10 * shear); /* G gamma^2 / 2 */
    record_release(&record);
    fixture_release(&fixture);
}

/* Random large strains: stress is the derivative of the energy (central differences, fourth order:
 * 1e-9), and the strain of a stress gives it back. */
static void check_large_strain(const struct fixture *fixture, const double strain[SYM3_COMPONENTS])
{
    const double offset = 1e-3;
    const double weights[4] = {1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0};
    const double places[4] = {-2.0, -1.0, 1.0, 2.0};
    double stress[SYM3_COMPONENTS];
    double back[SYM3_COMPONENTS];
    struct slots slots;
    slots_init(&slots, 8, 6);
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        double energy[8];
        double slope = 0.0;
        for (int other = 0; other < SYM3_COMPONENTS; other++) {
            for (size_t slot = 0; slot < 5; slot++) /* the last one stays where it is */
                slots.batch.strain[other][slot] =
                    strain[other] + (slot < 4 && other == component ? places[slot] * offset : 0.0);
        }
        fixture->material->strain_energy(fixture->constants, &slots.batch, energy);
        fixture->material->update_stress(fixture->constants, &slots.batch);
        for (int place = 0; place < 4; place++)
            slope += weights[place] * energy[place] / offset;
        stress[component] = slots.batch.stress[component][4];
        double pairs = component < 3 ? 1.0 : 2.0;
        assert_true(fabs(slope / pairs - stress[component]) < 1e-9 * bulk);
    }
    fixture->material->strain_from_stress(fixture->constants, stress, back);
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        assert_true(fabs(back[component] - strain[component]) < 1e-13);
    slots_release(&slots);
}

static void test_large_strains(void **context)
{
    (void)context;
    uint64_t state = 3;
    struct fixture fixture;
    fixture_init(&fixture, "neo_hookean", settings, LENGTH(settings));
    for (int trial = 0; trial < 200; trial++) {
        double strain[SYM3_COMPONENTS];
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            strain[component] = 0.4 * random_value(&state);
        check_large_strain(&fixture, strain);
    }
    fixture_release(&fixture);
}

/* As linear_elastic with the same moduli but for terms of the second order; the energy of strains
 * of 1e-7 still has its digits. */
static void test_small_strains(void **context)
{
    (void)context;
    uint64_t state = 4;
    struct fixture neo, linear;
    struct slots a, b;
    double neo_energy[64], linear_energy[64];
    const double size = 1e-7;
    fixture_init(&neo, "neo_hookean", settings, LENGTH(settings));
    fixture_init(&linear, "linear_elastic", settings, LENGTH(settings));
    slots_init(&a, 64, 6);
    slots_init(&b, 64, 6);
    for (size_t slot = 0; slot < 64; slot++) {
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            a.batch.strain[component][slot] = b.batch.strain[component][slot] =
                size * random_value(&state);
    }
    neo.material->update_stress(neo.constants, &a.batch);
    linear.material->update_stress(linear.constants, &b.batch);
    neo.material->strain_energy(neo.constants, &a.batch, neo_energy);
    linear.material->strain_energy(linear.constants, &b.batch, linear_energy);
    for (size_t slot = 0; slot < 64; slot++) {
        for (int component = 0; component < SYM3_COMPONENTS; component++)
            assert_true(fabs(a.batch.stress[component][slot] - b.batch.stress[component][slot]) <
                        20.0 * shear * size * size);
        assert_true(fabs(neo_energy[slot] / linear_energy[slot] - 1.0) < 10.0 * size);
    }
    slots_release(&a);
    slots_release(&b);
    fixture_release(&neo);
    fixture_release(&linear);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stretches),
        cmocka_unit_test(test_simple_shear),
        cmocka_unit_test(test_large_strains),
        cmocka_unit_test(test_small_strains),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "material_fixture.h"

static void init(struct fixture *fixture, double no_tension)
{
    const struct setting settings[] = {
        {"density", 1000.0}, {"bulk_modulus", 2e6}, {"viscosity", 3.0}, {"no_tension", no_tension}};
    fixture_init(fixture, "newtonian_fluid", settings, LENGTH(settings));
}

/* tau = K ln J 1 + J 2 mu d; dissipation J 2 mu d : d dt */
static void test_stress(void **context)
{
    (void)context;
    struct fixture fixture;
    struct slots slots;
    init(&fixture, 0.0);
    slots_init(&slots, 8, 6);
    const double rate[SYM3_COMPONENTS] = {1.0, -2.0, 0.5, 3.0, -1.0, 2.0};
    double square = 0.0;
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        slots.rate[component][0] = rate[component];
        square += (component < 3 ? 1.0 : 2.0) * rate[component] * rate[component];
    }
    slots.volume_ratio[0] = 1.1;
    slots.batch.strain[0][0] = log(1.1);
    slots.batch.strain[0][1] = -0.01;
    fixture.material->update_stress(fixture.constants, &slots.batch);
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        double expected =
            (component < 3 ? 2e6 * log(1.1) : 0.0) + 1.1 * 2.0 * 3.0 * rate[component];
        assert_true(fabs(slots.batch.stress[component][0] - expected) < 1e-9);
        assert_true(slots.batch.stress[component][1] == (component < 3 ? -2e4 : 0.0));
    }
    assert_true(fabs(slots.batch.dissipation[0] - 1.1 * 6.0 * square * 1e-3) < 1e-12);
    assert_true(slots.batch.plastic_strain[0] == 0.0);
    assert_true(slots.batch.strain[0][0] == log(1.1));
    assert_true(fixture.material->viscosity(fixture.constants) == 3.0);
    assert_true(fabs(fixture.material->wave_speed(fixture.constants) - sqrt(2e3)) < 1e-12);
    slots_release(&slots);
    fixture_release(&fixture);
}

/* No pull, no energy; the strain stays, so that load comes back only when the gap has closed. */
static void test_no_tension(void **context)
{
    (void)context;
    for (int no_tension = 0; no_tension < 2; no_tension++) {
        struct fixture fixture;
        struct slots slots;
        double energy[8];
        init(&fixture, no_tension);
        slots_init(&slots, 8, 4);
        slots.batch.strain[0][0] = 0.02;
        slots.batch.strain[0][1] = -0.02;
        fixture.material->update_stress(fixture.constants, &slots.batch);
        fixture.material->strain_energy(fixture.constants, &slots.batch, energy);
        assert_true(slots.batch.stress[0][0] == (no_tension ? 0.0 : 4e4));
        assert_true(slots.batch.stress[0][1] == -4e4);
        assert_true(fabs(energy[0] - (no_tension ? 0.0 : 400.0)) < 1e-10);
        assert_true(fabs(energy[1] - 400.0) < 1e-10);
        assert_true(slots.batch.strain[0][0] == 0.02);
        slots_release(&slots);
        fixture_release(&fixture);
    }
}

/* p = K/gamma (J^-gamma - 1), times J; the energy against its closed form, where that has digits,
 * and against K/2 (ln J)^2 of small strains; the strain of a stress. */
static void check_tait(double exponent, double no_tension)
{
    const double strains[8] = {-0.3, -0.02, -1e-8, 0.0, 1e-8, 0.02, 0.3, -0.1};
    const struct setting settings[] = {{"density", 1000.0},
                                       {"bulk_modulus", 2e6},
                                       {"equation_of_state", 1.0},
                                       {"exponent", exponent},
                                       {"no_tension", no_tension}};
    const double gamma = isnan(exponent) ? 7.0 : exponent;
    struct fixture fixture;
    struct slots slots;
    double energy[8];
    fixture_init(&fixture, "newtonian_fluid", settings, LENGTH(settings));
    slots_init(&slots, 8, 4);
    memcpy(slots.batch.strain[0], strains, sizeof strains);
    fixture.material->update_stress(fixture.constants, &slots.batch);
    fixture.material->strain_energy(fixture.constants, &slots.batch, energy);
    for (size_t slot = 0; slot < 8; slot++) {
        double strain = no_tension != 0.0 ? fmin(strains[slot], 0.0) : strains[slot];
        double volume = exp(strain);
        double pressure = 2e6 / gamma * expm1(-gamma * strain);
        double stress = slots.batch.stress[1][slot];
        double work = gamma == 1.0 ? volume - 1.0 - strain
                                   : (pow(volume, 1.0 - gamma) - gamma) / (gamma - 1.0) + volume;
        double expected = fabs(strain) > 1e-3 ? 2e6 / gamma * work : 1e6 * strain * strain;
        assert_true(fabs(stress + volume * pressure) <= 1e-13 * fabs(pressure));
        assert_true(fabs(energy[slot] - expected) <= 1e-7 * expected);
        double mean[SYM3_COMPONENTS] = {stress, stress, stress};
        double back[SYM3_COMPONENTS];
        fixture.material->strain_from_stress(fixture.constants, mean, back);
        assert_true(fabs(back[0] - strain) <= 1e-14);
    }
    assert_true(fabs(fixture.material->wave_speed(fixture.constants) - sqrt(2e3)) < 1e-12);
    slots_release(&slots);
    fixture_release(&fixture);
}

static void test_tait(void **context)
{
    (void)context;
    check_tait(NAN, 0.0); /* 7 */
    check_tait(7.0, 1.0);
    check_tait(1.0, 0.0);
    check_tait(2.5, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stress),
        cmocka_unit_test(test_no_tension),
        cmocka_unit_test(test_tait),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

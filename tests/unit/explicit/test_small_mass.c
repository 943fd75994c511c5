/* SPDX-License-Identifier: Apache-2.0 */
/* Nodes of little mass: their force is dropped and booked, or moved; momentum and threads. */
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}};

/* A block under pressure, whose edge has just entered new cells on all sides. */
static void build(struct simulation_fixture *fixture, size_t axes, enum talus_small_mass treatment)
{
    static const int64_t count[3] = {20, 20, 20};
    static const double min[3] = {0.5255, 0.5255, 0.5255}, max[3] = {0.8255, 0.8255, 0.8255};
    simulation_fixture_init(fixture, axes, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    struct talus_body *body = simulation_fixture_add_box(fixture, material, min, max, 2);
    for (size_t axis = 0; axis < 3; axis++) {
        body->velocity[axis] = axis < axes ? 0.1 : 0;
        body->stress[axis] = -1e4;
    }
    body->initial_stress = TALUS_INITIAL_GIVEN;
    fixture->scene.solver.small_mass = treatment;
    fixture->scene.solver.time_step = 2e-4;
    fixture->scene.energy_growth_limit = 1;
}

static void test_momentum(void **state)
{
    (void)state;
    for (int variant = 0; variant < 3 * TALUS_STRESS_UPDATE_COUNT; variant++) {
        for (int treatment = 1; treatment <= TALUS_SMALL_MASS_REDISTRIBUTE; treatment++) {
            struct simulation_fixture fixture;
            build(&fixture, (size_t)variant % 3 + 1, (enum talus_small_mass)treatment);
            fixture.scene.solver.stress_update = (enum talus_stress_update)(variant / 3);
            struct talus_simulation *one = simulation_fixture_start(&fixture, 1);
            struct talus_simulation *two = simulation_fixture_start(&fixture, 2);
            simulation_run_steps(one, 50);
            simulation_run_steps(two, 50);
            assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(two));
            assert_true(simulation_metric(one, "momentum_error") <= 1e-13);
            assert_true(simulation_metric(one, "mass_error") <= 1e-14);
            talus_simulation_destroy(one);
            talus_simulation_destroy(two);
        }
    }
}

/* Largest speed after one step: the free edge is pulled by its own light nodes, or as part of what
 * lies behind it. */
static double speed_after_a_step(enum talus_small_mass treatment)
{
    struct simulation_fixture fixture;
    build(&fixture, 2, treatment);
    fixture.scene.solver.stress_update = TALUS_STRESS_LAST;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 1);
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3), fastest = 0;
    for (size_t k = 0; k < 3 * simulation_particle_count(simulation); k++)
        fastest = fmax(fastest, fabs(velocity[k] - (k % 3 < 2 ? 0.1 : 0)));
    free(velocity);
    talus_simulation_destroy(simulation);
    return fastest;
}

static void test_effect(void **state)
{
    (void)state;
    const double kept = speed_after_a_step(TALUS_SMALL_MASS_NONE);
    const double dropped = speed_after_a_step(TALUS_SMALL_MASS_CUTOFF);
    const double shared = speed_after_a_step(TALUS_SMALL_MASS_REDISTRIBUTE);
    print_message("speed gained: %.3g m/s, dropped %.3g, shared %.3g\n", kept, dropped, shared);
    assert_true(kept > 0);
    assert_true(dropped < 0.9 * kept);
    assert_true(fabs(shared - kept) > 0.01 * kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_momentum),
        cmocka_unit_test(test_effect),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

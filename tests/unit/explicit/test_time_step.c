/* SPDX-License-Identifier: Apache-2.0 */
/* The automatic step is the one that the particles of the scene need. */
#include "simulation_fixture.h"

#define CELL 0.1
/* Courant number x limit of modified_last with linear shapes. */
#define SHARE (0.4 * 1.26)

/* c = sqrt(1.2 E / rho) with nu = 1/4. */
static const struct setting stiff[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.25}};
static const struct setting soft[] = {
    {"density", 1000}, {"young_modulus", 1e5}, {"poisson_ratio", 0.25}};
static const struct setting stiffest[] = {
    {"density", 1000}, {"young_modulus", 1e9}, {"poisson_ratio", 0.25}};

static double wave_speed(const struct setting settings[3])
{
    return sqrt(1.2 * settings[1].value / settings[0].value);
}

/* A stiff body at rest and a soft one that flies towards it; a material that no body is of. */
static void build(struct simulation_fixture *fixture, double speed)
{
    simulation_fixture_init(fixture, 2, CELL, (const int64_t[3]){60, 20, 1});
    (void)simulation_fixture_add_material(fixture, "linear_elastic", stiffest, LENGTH(stiffest));
    const size_t rock =
        simulation_fixture_add_material(fixture, "linear_elastic", stiff, LENGTH(stiff));
    const size_t gel =
        simulation_fixture_add_material(fixture, "linear_elastic", soft, LENGTH(soft));
    simulation_fixture_add_box(fixture, rock, (const double[3]){3.0, 0.5, 0},
                               (const double[3]){4.0, 1.5, 0}, 2);
    simulation_fixture_add_box(fixture, gel, (const double[3]){1.0, 0.8, 0},
                               (const double[3]){2.0, 1.2, 0}, 2)
        ->velocity[0] = speed;
}

/* Sum of wave speed and velocity that the present step stands for. */
static double signal_speed(const struct talus_simulation *simulation)
{
    struct talus_simulation_state state;
    talus_simulation_get_state(simulation, &state);
    return SHARE * CELL / state.time_step;
}

static void test_speeds_are_of_the_same_particle(void **state)
{
    (void)state;
    const double speeds[3] = {1.0, 20.0, 60.0};
    for (size_t index = 0; index < 3; index++) {
        struct simulation_fixture fixture;
        struct talus_estimate estimate;
        struct talus_error error = {0};
        build(&fixture, speeds[index]);
        const double expected = fmax(wave_speed(stiff), wave_speed(soft) + speeds[index]);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        assert_close(signal_speed(simulation), expected, 1e-9, expected);
        assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
        assert_close(SHARE * CELL / estimate.time_step, expected, 1e-9, expected);
        talus_simulation_destroy(simulation);
    }
}

/* The step is larger than that of the fastest wave with the fastest particle, and holds through the
 * collision, the rebound and the flight after it. */
static void test_collision_is_stable(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 8);
    fixture.scene.duration = 0.35;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct talus_simulation_state now;
    struct talus_error error = {0};
    double least = INFINITY;
    do {
        assert_int_equal(talus_simulation_step(simulation, &error), TALUS_OK);
        least = fmin(least, signal_speed(simulation));
        talus_simulation_get_state(simulation, &now);
    } while (now.time < 0.34);
    assert_true(least < wave_speed(stiff) + 8);
    /* They have met: the stiff body moves, and the soft one has turned or stopped. */
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
    double *body = simulation_field(simulation, TALUS_FIELD_BODY, 1);
    double mean[2] = {0, 0}, count[2] = {0, 0};
    for (size_t k = 0; k < simulation_particle_count(simulation); k++) {
        mean[(size_t)body[k]] += velocity[3 * k];
        count[(size_t)body[k]] += 1;
    }
    assert_true(mean[0] / count[0] > 1);
    assert_true(mean[1] / count[1] < 4);
    free(velocity);
    free(body);
    assert_true(simulation_metric(simulation, "energy_error") < 0.01);
    assert_int_equal(talus_simulation_audit(simulation, &error), TALUS_OK);
    talus_simulation_destroy(simulation);
}

/* A material whose particles have all left does not count any more. */
static void test_what_has_left_does_not_count(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 0);
    fixture.scene.grid.outside = TALUS_OUTSIDE_ELIMINATE;
    fixture.scene.grid.outside_mass_limit = 1;
    fixture.bodies[0].velocity[0] = 30;
    fixture.scene.duration = 0.2;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct talus_simulation_state now;
    struct talus_error error = {0};
    assert_close(signal_speed(simulation), wave_speed(stiff) + 30, 1e-9, 1);
    do {
        assert_int_equal(talus_simulation_step(simulation, &error), TALUS_OK);
        talus_simulation_get_state(simulation, &now);
    } while (now.time < 0.15);
    assert_int_equal(now.particle_count, 4 * 10 * 4);
    assert_close(signal_speed(simulation), wave_speed(soft), 1e-6, wave_speed(soft));
    talus_simulation_destroy(simulation);
}

/* 12,300 fixed steps sum up to a little less than the duration: no step is made of the rest. */
static void test_rounding_makes_no_step(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_simulation_state now;
    struct talus_error error = {0};
    simulation_fixture_init(&fixture, 2, CELL, (const int64_t[3]){8, 8, 1});
    const size_t gel =
        simulation_fixture_add_material(&fixture, "linear_elastic", soft, LENGTH(soft));
    simulation_fixture_add_box(&fixture, gel, (const double[3]){0.4, 0.4, 0},
                               (const double[3]){0.5, 0.5, 0}, 1);
    fixture.scene.solver.time_step = 1e-5;
    fixture.scene.duration = 0.123;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    do {
        assert_int_equal(talus_simulation_step(simulation, &error), TALUS_OK);
        talus_simulation_get_state(simulation, &now);
    } while (!now.finished);
    assert_int_equal(now.step, 12300);
    assert_true(now.time == 0.123);
    talus_simulation_destroy(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_speeds_are_of_the_same_particle),
        cmocka_unit_test(test_collision_is_stable),
        cmocka_unit_test(test_what_has_left_does_not_count),
        cmocka_unit_test(test_rounding_makes_no_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

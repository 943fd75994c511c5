/* SPDX-License-Identifier: Apache-2.0 */
/* Where single precision is refused, and what it costs; asked of the build for double precision. */
#include "simulation_fixture.h"

/* A column of 1 m by 1 m on the floor in cells of 0.1 m, of that stiffness, under gravity. */
static void column(struct simulation_fixture *fixture, double young_modulus, double duration)
{
    const struct setting elastic[] = {
        {"density", 2000}, {"young_modulus", young_modulus}, {"poisson_ratio", 0.25}};
    const int64_t count[3] = {20, 20, 1};
    const double min[3] = {0, 0, 0}, max[3] = {1, 1, 0};
    simulation_fixture_init(fixture, 2, 0.1, count);
    fixture->scene.solver.precision = TALUS_PRECISION_SINGLE;
    fixture->scene.gravity[1] = -9.81;
    fixture->scene.duration = duration;
    const size_t material = simulation_fixture_add_material(fixture, "linear_elastic", elastic, 3);
    (void)simulation_fixture_add_box(fixture, material, min, max, 2);
    (void)simulation_fixture_add_plane(fixture, "floor", 1, 0, 1, "slip", 0);
}

static struct talus_estimate estimate_of(const struct simulation_fixture *fixture)
{
    struct talus_estimate estimate;
    struct talus_error error = {.status = TALUS_OK};
    if (talus_simulation_estimate(&fixture->scene, &estimate, &error) != TALUS_OK)
        fail_msg("%s: %s", error.pointer, error.text);
    return estimate;
}

static void assert_refused(struct simulation_fixture *fixture, const char *reason)
{
    struct talus_estimate estimate;
    struct talus_error error = {.status = TALUS_OK};
    fixture->scene.solver.precision = TALUS_PRECISION_DOUBLE;
    assert_int_equal(talus_simulation_estimate(&fixture->scene, &estimate, &error), TALUS_OK);
    assert_true(estimate.motion_error == 0 && estimate.force_noise == 0);
    fixture->scene.solver.precision = TALUS_PRECISION_SINGLE;
    assert_int_equal(talus_simulation_estimate(&fixture->scene, &estimate, &error), TALUS_INVALID);
    assert_string_equal(error.code, "precision");
    assert_string_equal(error.pointer, "/solver/precision");
    assert_non_null(strstr(error.text, reason));
    assert_non_null(strstr(error.text, "use \"double\""));
}

static void half_of_the_numbers(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    column(&fixture, 1e7, 1);
    const struct talus_estimate single = estimate_of(&fixture);
    fixture.scene.solver.precision = TALUS_PRECISION_DOUBLE;
    const struct talus_estimate twice = estimate_of(&fixture);
    const uint64_t id = sizeof(uint32_t);
    assert_int_equal(2 * (single.bytes_per_particle - id), twice.bytes_per_particle - id);
    assert_true(single.memory_bytes < twice.memory_bytes);
    assert_true(single.motion_error > 0 && single.motion_error < 0.01);
    assert_true(single.force_noise > 0 && single.force_noise < 0.01);
}

/* Its weight moves steel by less per step than a float of a position can tell. */
static void stiff_settling_is_refused(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    column(&fixture, 2e11, 1e-3);
    assert_refused(&fixture, "rounding of positions");
    fixture.bodies[0].initial_stress = TALUS_INITIAL_GEOSTATIC;
    fixture.bodies[0].k0 = 0.4;
    (void)estimate_of(&fixture);
}

static void slow_growth_is_refused(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    column(&fixture, 1e9, 0.1);
    (void)estimate_of(&fixture);
    fixture.scene.solver.force_ramp = 0.1;
    assert_refused(&fixture, "rounding of positions");
    fixture.scene.solver.force_ramp = 0;
    fixture.scene.solver.local_damping = 0.99;
    assert_refused(&fixture, "rounding of positions");
}

static void creeping_is_refused(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    column(&fixture, 1e7, 1);
    fixture.scene.gravity[1] = 0;
    fixture.bodies[0].velocity[0] = 1e-2;
    (void)estimate_of(&fixture);
    fixture.bodies[0].velocity[0] = 1e-5;
    assert_refused(&fixture, "rounding of positions");
}

static void noise_and_steps_are_refused(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    column(&fixture, 3e10, 1);
    fixture.bodies[0].initial_stress = TALUS_INITIAL_GEOSTATIC;
    fixture.bodies[0].k0 = 0.4;
    (void)estimate_of(&fixture);
    fixture.scene.duration = 1000;
    assert_refused(&fixture, "noise");
    column(&fixture, 1e7, 2e4);
    assert_refused(&fixture, "steps");
}

static void the_range_of_floats_is_kept(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    column(&fixture, 1e13, 1e-6);
    fixture.scene.gravity[1] = 0;
    assert_refused(&fixture, "stiffness");
}

static void a_build_runs_its_own_precision(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {.status = TALUS_OK};
    const struct talus_simulation_options options = {.threads = 1};
    column(&fixture, 1e7, 1);
    assert_int_equal(talus_simulation_create(&fixture.scene, &options, &simulation, &error),
                     TALUS_UNSUPPORTED);
    assert_string_equal(error.pointer, "/solver/precision");
    assert_null(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_of_the_numbers),
        cmocka_unit_test(stiff_settling_is_refused),
        cmocka_unit_test(slow_growth_is_refused),
        cmocka_unit_test(creeping_is_refused),
        cmocka_unit_test(noise_and_steps_are_refused),
        cmocka_unit_test(the_range_of_floats_is_kept),
        cmocka_unit_test(a_build_runs_its_own_precision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Automatic steps shrink while a scene speeds up: the number that is forecast holds the number that
 * the run takes. */
#include "simulation_fixture.h"

/* K = 1 kPa at 1000 kg/m^3, waves of 1.5 m/s: as slow as what moves here. */
static const struct setting soft[] = {
    {"density", 1000}, {"bulk_modulus", 1e3}, {"shear_modulus", 1e3}};

static struct talus_body *build(struct simulation_fixture *fixture, double bottom)
{
    static const int64_t count[3] = {20, 30, 1};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", soft, LENGTH(soft));
    simulation_fixture_add_plane(fixture, "floor", 1, 0.2, 1, "slip", 0);
    return simulation_fixture_add_box(fixture, material, (double[3]){0.8, bottom},
                                      (double[3]){1.2, bottom + 0.4}, 2);
}

static uint64_t steps_taken(const struct simulation_fixture *fixture)
{
    struct talus_simulation_state now;
    struct talus_error error = {0};
    struct talus_simulation *simulation = simulation_fixture_start(fixture, 1);
    do {
        assert_int_equal(talus_simulation_step(simulation, &error), TALUS_OK);
        talus_simulation_get_state(simulation, &now);
    } while (!now.finished);
    talus_simulation_destroy(simulation);
    return now.step;
}

static struct talus_estimate estimate_of(const struct simulation_fixture *fixture)
{
    struct talus_estimate estimate;
    struct talus_error error = {0};
    assert_int_equal(talus_simulation_estimate(&fixture->scene, &estimate, &error), TALUS_OK);
    return estimate;
}

/* Compares, and returns by how much the steps grow over those of a scene at rest. */
static double check(const struct simulation_fixture *fixture)
{
    const struct talus_estimate estimate = estimate_of(fixture);
    const uint64_t taken = steps_taken(fixture);
    if (taken < estimate.step_count_low || taken > estimate.step_count_high)
        fail_msg("%llu steps, not %llu to %llu", (unsigned long long)taken,
                 (unsigned long long)estimate.step_count_low,
                 (unsigned long long)estimate.step_count_high);
    assert_true(estimate.step_count_low <= estimate.step_count);
    assert_true(estimate.step_count <= estimate.step_count_high);
    return (double)taken / (double)estimate.step_count_low;
}

static void test_falling(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 2.2);
    fixture.scene.gravity[1] = -2;
    fixture.scene.duration = 1.2; /* in the air all the time: 2.4 m/s at the end */
    assert_true(check(&fixture) > 1.3);
    /* In the air, half the speed at the end is the mean, and half of that is expected. */
    const struct talus_estimate estimate = estimate_of(&fixture);
    assert_true((double)estimate.step_count > 1.2 * (double)estimate.step_count_low);
}

static void test_landing(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 0.7);
    fixture.scene.gravity[1] = -1;
    fixture.scene.duration = 3;
    assert_true(check(&fixture) > 1.02);
}

/* A floor in the way of the fall leaves less to gain. */
static void test_floors_stop_the_fall(void **state)
{
    (void)state;
    struct simulation_fixture deep, shallow;
    build(&deep, 1.6);
    build(&shallow, 1.6);
    deep.scene.gravity[1] = shallow.scene.gravity[1] = -2;
    shallow.boundaries[0].point[1] = 1.5;
    assert_true(estimate_of(&shallow).step_count_high < estimate_of(&deep).step_count_high);
    assert_int_equal(estimate_of(&shallow).step_count_low, estimate_of(&deep).step_count_low);
}

static void test_flying(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 1.0)->velocity[1] = 0.5;
    assert_true(check(&fixture) > 1.2);
    const struct talus_estimate estimate = estimate_of(&fixture);
    /* Nothing slows it down: what the initial speed asks for is expected. */
    assert_true(fabs((double)estimate.step_count * estimate.time_step - 1) <= estimate.time_step);
}

static void test_pushed_by_a_wall(void **state)
{
    (void)state;
    struct simulation_fixture still, pushed;
    build(&still, 0.2);
    build(&pushed, 0.2);
    struct talus_boundary *wall =
        simulation_fixture_add_plane(&pushed, "piston", 0, 0.7, 1, "velocity", 0);
    wall->prescribed = 1;
    wall->velocity[0] = 0.8;
    pushed.scene.duration = 0.5;
    still.scene.duration = 0.5;
    assert_true(check(&pushed) > 1.1);
    assert_true(estimate_of(&pushed).step_count > estimate_of(&still).step_count);
}

static void test_fixed_steps_are_known(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 0.7);
    fixture.scene.gravity[1] = -1;
    fixture.scene.solver.time_step = 0.003;
    (void)check(&fixture);
    const struct talus_estimate estimate = estimate_of(&fixture);
    assert_int_equal(estimate.step_count, 334);
    assert_true(estimate.step_count_high - estimate.step_count_low <= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_falling),
        cmocka_unit_test(test_landing),
        cmocka_unit_test(test_floors_stop_the_fall),
        cmocka_unit_test(test_flying),
        cmocka_unit_test(test_pushed_by_a_wall),
        cmocka_unit_test(test_fixed_steps_are_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

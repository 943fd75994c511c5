/* SPDX-License-Identifier: Apache-2.0 */
/* Gravity that varies over time or with the place. */
#include "simulation_fixture.h"

static void fill(struct simulation_fixture *fixture, double bottom)
{
    const int64_t count[3] = {60, 40, 1};
    const double min[3] = {1.0, bottom, 0}, max[3] = {1.5, bottom + 0.5, 0};
    static const struct setting elastic[] = {
        {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material = simulation_fixture_add_material(fixture, "linear_elastic", elastic,
                                                            sizeof elastic / sizeof elastic[0]);
    simulation_fixture_add_box(fixture, material, min, max, 2);
    fixture->scene.solver.time_step = 2e-4;
}

static double mean_velocity(const struct talus_simulation *simulation, size_t axis)
{
    const size_t count = simulation_particle_count(simulation);
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3), sum = 0;
    for (size_t index = 0; index < count; index++)
        sum += velocity[3 * index + axis];
    free(velocity);
    return sum / (double)count;
}

/* A free body: its velocity is the integral of the table, exactly, and its energy is in the books.
 */
static void free_fall_follows_the_table(void **state)
{
    (void)state;
    double times[] = {0.05, 0.15, 0.25}, values[] = {0.0, -20.0, 10.0};
    struct simulation_fixture fixture;
    fill(&fixture, 1.0);
    fixture.scene.gravity[0] = 1.0;
    fixture.scene.gravity_table[1] =
        (struct talus_time_table){.count = 3, .time = times, .value = values};
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 1500); /* 0.3 s */
    assert_close(mean_velocity(simulation, 0), 0.3, 1e-10, 1.0);
    /* 0.05 s of nothing, triangle and trapezium, 0.05 s of 10 */
    assert_close(mean_velocity(simulation, 1), -1.0 - 0.5 + 0.5, 1e-10, 1.0);
    /* What a step loses in time integration, 1/2 dt integral of g^2, is 2.8 mJ/kg; 0.55 J/kg are
     * in the motion. */
    struct talus_error error = {0};
    assert_int_equal(talus_simulation_audit(simulation, &error), TALUS_OK);
    assert_true(fabs(simulation_metric(simulation, "energy_numerical")) < 6e-3);
    talus_simulation_destroy(simulation);
}

/* With a ramp on top, at rest on a floor that takes it all: the books close too. */
static void table_and_ramp_are_booked(void **state)
{
    (void)state;
    double times[] = {0.0, 0.3}, values[] = {-4.0, -12.0};
    struct simulation_fixture fixture;
    fill(&fixture, 0.0);
    simulation_fixture_add_plane(&fixture, "floor", TALUS_Y, 0.0, 1.0, "slip", 0);
    fixture.scene.gravity[1] = values[0];
    fixture.scene.gravity_table[1] =
        (struct talus_time_table){.count = 2, .time = times, .value = values};
    fixture.scene.solver.force_ramp = 0.1;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 1500);
    struct talus_error error = {0};
    assert_int_equal(talus_simulation_audit(simulation, &error), TALUS_OK);
    assert_true(fabs(simulation_metric(simulation, "energy_numerical")) < 0.03);
    talus_simulation_destroy(simulation);
}

/* Everywhere on the slope: as gravity in that direction. */
static void a_slope_tilts_gravity(void **state)
{
    (void)state;
    const double pi = 3.14159265358979323846, angle = 25 * pi / 180, friction = 0.2;
    struct talus_slope slope = {.along = {1, 0, 0}, .below = 100, .beyond = NAN, .angle_deg = 25};
    struct simulation_fixture sloped, tilted;
    fill(&sloped, 0.0);
    fill(&tilted, 0.0);
    simulation_fixture_add_plane(&sloped, "bed", TALUS_Y, 0.0, 1.0, "friction", friction);
    simulation_fixture_add_plane(&tilted, "bed", TALUS_Y, 0.0, 1.0, "friction", friction);
    sloped.scene.gravity[1] = -10;
    sloped.scene.slopes = &slope;
    sloped.scene.slope_count = 1;
    tilted.scene.gravity[0] = 10 * sin(angle);
    tilted.scene.gravity[1] = -10 * cos(angle);
    struct talus_simulation *a = simulation_fixture_start(&sloped, 1);
    struct talus_simulation *b = simulation_fixture_start(&tilted, 1);
    simulation_run_steps(a, 2000);
    simulation_run_steps(b, 2000);
    double *left = simulation_field(a, TALUS_FIELD_VELOCITY, 3);
    double *right = simulation_field(b, TALUS_FIELD_VELOCITY, 3);
    for (size_t index = 0; index < 3 * simulation_particle_count(a); index++)
        assert_close(left[index], right[index], 1e-8, 1.0);
    /* A sliding block; it bounces a little after it is let go. */
    assert_close(mean_velocity(a, 0), 0.4 * 10 * (sin(angle) - friction * cos(angle)), 0.02, 1.0);
    struct talus_error error = {0};
    assert_int_equal(talus_simulation_audit(a, &error), TALUS_OK);
    assert_close(simulation_metric(a, "energy_numerical"), simulation_metric(b, "energy_numerical"),
                 1e-6, 1.0);
    free(left);
    free(right);
    talus_simulation_destroy(a);
    talus_simulation_destroy(b);
}

/* The first slope that holds counts; beyond all of them gravity is straight down. */
static void slopes_hold_in_their_zones(void **state)
{
    (void)state;
    const double pi = 3.14159265358979323846;
    struct talus_slope slopes[2] = {
        {.along = {1, 0, 0}, .below = NAN, .about = {3, 9, 0}, .beyond = 1.75, .angle_deg = 30},
        {.along = {1, 0, 0}, .below = 2.5, .beyond = NAN, .angle_deg = 60}};
    struct simulation_fixture fixture;
    fill(&fixture, 1.0);
    fixture.bodies[0].box_max[0] = 3.0; /* from 1 to 3 m: 30 deg to 1.25, 60 deg to 2.5, 0 */
    fixture.scene.gravity[1] = -10;
    fixture.scene.slopes = slopes;
    fixture.scene.slope_count = 2;
    fixture.scene.solver.time_step = 1e-5;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 1);
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
    const size_t count = simulation_particle_count(simulation);
    double particles = 0, expected[2] = {0, 0}, sum[2] = {0, 0};
    for (size_t index = 0; index < count; index++) {
        const double x = 1.025 + 0.05 * (double)(index % 40);
        const double angle = (x < 1.25 ? 30 : x < 2.5 ? 60 : 0) * pi / 180;
        expected[0] += 1e-5 * 10 * sin(angle);
        expected[1] -= 1e-5 * 10 * cos(angle);
        for (size_t axis = 0; axis < 2; axis++)
            sum[axis] += velocity[3 * index + axis];
        if (x < 1.1 || x > 2.6 || (x > 1.4 && x < 2.4)) { /* no node with the next zone */
            assert_close(velocity[3 * index], 1e-5 * 10 * sin(angle), 1e-9, 1e-4);
            assert_close(velocity[3 * index + 1], -1e-5 * 10 * cos(angle), 1e-9, 1e-4);
            particles++;
        }
    }
    assert_true(particles > 0.7 * (double)count);
    for (size_t axis = 0; axis < 2; axis++)
        assert_close(sum[axis], expected[axis], 1e-9, 1e-4 * (double)count);
    free(velocity);
    talus_simulation_destroy(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_fall_follows_the_table),
        cmocka_unit_test(table_and_ramp_are_booked),
        cmocka_unit_test(a_slope_tilts_gravity),
        cmocka_unit_test(slopes_hold_in_their_zones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Adhesion and turbulence on a bed: a slab of depth H, 0.2 m, and length 0.8 m slides along x under
 * the component G of gravity, pushed onto the bed by N. Along its length all columns are alike, so
 * its mean motion is that of a point: dv/dt = G - mu N - a / (rho H) - g v^2 / (xi H). */
#include "simulation_fixture.h"

#define ALONG 4.0
#define ONTO 9.0
#define DEPTH 0.2

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.25}};

static struct talus_boundary *build(struct simulation_fixture *fixture, double friction)
{
    static const int64_t count[3] = {300, 8, 1};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    simulation_fixture_add_box(fixture, material, (double[3]){0.63, 0.2}, (double[3]){1.43, 0.4},
                               2);
    fixture->scene.gravity[0] = ALONG;
    fixture->scene.gravity[1] = -ONTO;
    fixture->scene.solver.viscous_damping = 0.5;
    return simulation_fixture_add_plane(fixture, "bed", 1, 0.2, 1, "friction", friction);
}

/* Mean speed along the bed after so many seconds. */
static double slide(struct simulation_fixture *fixture, double seconds)
{
    fixture->scene.duration = seconds;
    struct talus_simulation *simulation = simulation_fixture_start(fixture, 1);
    struct talus_simulation_state now;
    do {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_clock(simulation, &now);
    } while (!now.finished);
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3), sum = 0;
    const size_t count = simulation_particle_count(simulation);
    for (size_t k = 0; k < count; k++)
        sum += velocity[3 * k];
    assert_true(simulation_metric(simulation, "momentum_error") < 1e-12);
    free(velocity);
    talus_simulation_destroy(simulation);
    return sum / (double)count;
}

/* 800 Pa pull along the bed; adhesion of 400 Pa takes half of it, of 1600 Pa all. The area is the
 * length of the slab, wherever it lies between the nodes. */
static void test_adhesion(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 0)->faces[0].adhesion = 400;
    assert_close(slide(&fixture, 0.5), 0.5 * (ALONG - 400 / (1000 * DEPTH)), 0.02, 1);
    build(&fixture, 0)->faces[0].adhesion = 1600;
    assert_close(slide(&fixture, 0.5), 0, 0.02, 1);
}

/* Without end: v^2 = xi H (G - mu N) / g, with g the magnitude of gravity. */
static void test_turbulence(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 0.2)->faces[0].turbulence = 100;
    const double limit = sqrt(100 * DEPTH * (ALONG - 0.2 * ONTO) / hypot(ALONG, ONTO));
    const double gain = ALONG - 0.2 * ONTO;
    assert_close(slide(&fixture, 1.0), limit * tanh(gain * 1.0 / limit), 0.03, limit);
    build(&fixture, 0.2)->faces[0].turbulence = 100;
    assert_close(slide(&fixture, 4.0), limit, 0.02, limit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_adhesion),
        cmocka_unit_test(test_turbulence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

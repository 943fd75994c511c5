/* SPDX-License-Identifier: Apache-2.0 */
/* What a step does as a whole: rigid motion, ramp, PIC share, conservation, convergence of the
 * books. */
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.25}};

static void build(struct simulation_fixture *fixture, size_t axes)
{
    static const int64_t count[3] = {30, 30, 20};
    simulation_fixture_init(fixture, axes, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    simulation_fixture_add_box(fixture, material, (double[3]){0.8, 1.0, 0.5},
                               (double[3]){1.3, 1.4, 0.7}, 2);
}

static void set_motion(struct simulation_fixture *fixture)
{
    static const double velocity[3] = {1.7, -0.9, 0.6};
    for (size_t axis = 0; axis < fixture->scene.axis_count; axis++) {
        fixture->bodies[0].velocity[axis] = velocity[axis];
        fixture->scene.gravity[axis] = axis == 0 ? 2.0 : -3.0;
    }
}

/* A free block in a field of gravity: every particle on its parabola, no stress, whatever cells it
 * crosses. */
static void check_free_fall(double theta)
{
    for (int update = 0; update < TALUS_STRESS_UPDATE_COUNT; update++) {
        for (size_t axes = 1; axes <= 3; axes++) {
            struct simulation_fixture fixture;
            build(&fixture, axes);
            set_motion(&fixture);
            fixture.scene.solver.time_step = 5e-4;
            fixture.scene.solver.stress_update = (enum talus_stress_update)update;
            fixture.scene.solver.theta = theta;
            fixture.scene.output.frame_fields = 1u << TALUS_FIELD_STRESS;
            struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
            const size_t count = simulation_particle_count(simulation), steps = 400;
            double *start = calloc(6 * count, sizeof *start), *now = start + 3 * count;
            assert_non_null(start);
            talus_simulation_read_positions(simulation, start);
            simulation_run_steps(simulation, steps);
            talus_simulation_read_positions(simulation, now);
            double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
            double *stress = simulation_field(simulation, TALUS_FIELD_STRESS, 6);
            const double t = 0.2, n = (double)steps;
            for (size_t k = 0; k < count; k++) {
                for (size_t axis = 0; axis < axes; axis++) {
                    const double v = fixture.bodies[0].velocity[axis];
                    const double g = fixture.scene.gravity[axis];
                    assert_close(velocity[3 * k + axis], v + g * t, 1e-11, 1);
                    /* sum of dt (v + g dt (j - 1 + theta)), j = 1 ... n */
                    assert_close(now[3 * k + axis] - start[3 * k + axis],
                                 v * t + g * t * t * 0.5 * (n - 1 + 2 * theta) / n, 1e-11, 1);
                }
                for (size_t component = 0; component < 6; component++)
                    assert_close(stress[6 * k + component], 0, 1e-5, 1);
            }
            free(start);
            free(velocity);
            free(stress);
            talus_simulation_destroy(simulation);
        }
    }
}

static void test_free_fall_is_exact(void **state)
{
    (void)state;
    check_free_fall(1.0);
    check_free_fall(0.5); /* the parabola itself (Andersen and Andersen 2012, eq. 31) */
}

/* v = sum of dt g min(1, t/T) at the ends of the steps. */
static void test_force_ramp(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 2);
    fixture.scene.gravity[1] = -10;
    fixture.scene.solver.force_ramp = 0.05;
    fixture.scene.solver.time_step = 1e-3;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    double expected = 0;
    for (size_t step = 1; step <= 100; step++) {
        simulation_run_steps(simulation, 1);
        expected -= 10 * 1e-3 * fmin(1.0, (double)step * 1e-3 / 0.05);
        double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
        assert_close(velocity[1], expected, 1e-12, 1);
        free(velocity);
    }
    assert_close(expected, -10 * (0.1 - 0.5 * 0.05), 0.006, 1);
    /* What the ramp holds back is external work, not a loss. */
    assert_true(fabs(simulation_metric(simulation, "energy_numerical")) < 0.03);
    talus_simulation_destroy(simulation);
}

/* Kinetic energy of random particle velocities that the grid cannot hold decays by the PIC share
 * alone, at a rate that does not depend on the step. */
static double decay(double time_step, double pic_rate)
{
    struct simulation_fixture fixture;
    build(&fixture, 2);
    /* So soft that nothing but the transfer matters. */
    const size_t young = material_parameter_index(material_find("linear_elastic"), "young_modulus");
    fixture.values[0][young] = 1e-3;
    /* A second block in the same cells, against the first: the grid sees almost no motion. */
    simulation_fixture_add_box(&fixture, 0, (double[3]){0.8, 1.0}, (double[3]){1.3, 1.4}, 2);
    fixture.bodies[0].velocity[0] = 0.1;
    fixture.bodies[1].velocity[0] = -0.1;
    fixture.scene.solver.pic_rate = pic_rate;
    fixture.scene.solver.time_step = time_step;
    fixture.scene.duration = 0.1;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, (size_t)lround(0.1 / time_step));
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3), largest = 0;
    for (size_t k = 0; k < simulation_particle_count(simulation); k++)
        largest = fmax(largest, fabs(velocity[3 * k]));
    free(velocity);
    talus_simulation_destroy(simulation);
    return largest / 0.1;
}

static void test_pic_share_does_not_depend_on_the_step(void **state)
{
    (void)state;
    static const double steps[3] = {1e-3, 2.5e-3, 1e-2};
    for (size_t index = 0; index < LENGTH(steps); index++) {
        assert_close(decay(steps[index], 0), 1, 1e-6, 1);
        assert_close(decay(steps[index], 8), exp(-0.8), 1e-6, 1);
    }
}

/* Momentum and mass to round-off for every material and both orderings, in a body that deforms. */
static void test_conservation(void **state)
{
    (void)state;
    for (size_t index = 0; index < material_count; index++) {
        for (int update = 0; update < TALUS_STRESS_UPDATE_COUNT; update++) {
            struct simulation_fixture fixture;
            static const int64_t count[3] = {30, 30, 20};
            simulation_fixture_init(&fixture, 2, 0.1, count);
            const size_t material = simulation_fixture_add_sample(&fixture, material_table[index]);
            for (size_t body = 0; body < 2; body++) {
                const double x = 0.8 + 0.4 * (double)body;
                simulation_fixture_add_box(&fixture, material, (double[3]){x, 1.0},
                                           (double[3]){x + 0.4, 1.3}, 2)
                    ->velocity[0] = body == 0 ? 0.4 : 0.0;
            }
            fixture.scene.solver.stress_update = (enum talus_stress_update)update;
            fixture.scene.solver.anti_locking = TALUS_CONTROL_CELL;
            fixture.scene.solver.viscous_damping = 0.1;
            struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
            simulation_run_steps(simulation, 60);
            assert_true(simulation_metric(simulation, "mass_error") <= 1e-14);
            assert_true(simulation_metric(simulation, "momentum_error") <= 1e-13);
            /* Just after an impact the energies of velocities and strains, which are half a step
             * apart, oscillate by a few percent. */
            assert_true(simulation_metric(simulation, "energy_error") <= 0.05);
            assert_true(simulation_metric(simulation, "energy_numerical") < 0.6);
            talus_simulation_destroy(simulation);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_fall_is_exact),
        cmocka_unit_test(test_force_ramp),
        cmocka_unit_test(test_pic_share_does_not_depend_on_the_step),
        cmocka_unit_test(test_conservation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

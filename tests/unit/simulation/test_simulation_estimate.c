/* SPDX-License-Identifier: Apache-2.0 */
/* What a scene costs, steps that are too large, and the end of a run. */
#include "shapes/shape.h"
#include "simulation_fixture.h"
#include "transfers/velocity_transfer.h"

/* K = 2 MPa, G = 1.5 MPa at 1000 kg/m^3: waves of sqrt(4000) m/s. */
static const struct setting elastic[] = {
    {"density", 1000}, {"bulk_modulus", 2e6}, {"shear_modulus", 1.5e6}};

static void build(struct simulation_fixture *fixture, double velocity)
{
    static const int64_t count[3] = {80, 16, 12};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    simulation_fixture_add_box(fixture, material, (double[3]){0.4, 0.2}, (double[3]){0.8, 0.5}, 2)
        ->velocity[0] = velocity;
}

static void test_critical_step(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_estimate estimate;
    struct talus_error error = {0};
    build(&fixture, 10);
    const double limits[TALUS_STRESS_UPDATE_COUNT] = {1.26, 0.63, 1.26};
    for (int update = 0; update < TALUS_STRESS_UPDATE_COUNT; update++) {
        fixture.scene.solver.stress_update = (enum talus_stress_update)update;
        assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
        const double critical = limits[update] * 0.1 / (sqrt(4000) + 10);
        assert_close(estimate.critical_time_step, critical, 1e-12, critical);
        assert_close(estimate.time_step, 0.4 * critical, 1e-12, critical);
        assert_int_equal(estimate.step_count, (uint64_t)ceil(1.0 / (0.4 * critical)));
        assert_int_equal(estimate.particle_count, 48);
        assert_int_equal(estimate.active_cell_count, 12);
        struct talus_simulation_state now;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        talus_simulation_get_state(simulation, &now);
        assert_close(now.time_step, estimate.time_step, 1e-12, critical);
        assert_int_equal(now.particle_count, estimate.particle_count);
        assert_int_equal(now.active_cell_count, estimate.active_cell_count);
        assert_true(now.memory_bytes <= estimate.memory_bytes);
        talus_simulation_destroy(simulation);
    }
}

/* The estimate is the memory of the run, from above and not by much, in two and three dimensions,
 * for a block, a plate and a tower. */
static void check_memory(size_t axes, const double size[3], size_t shape_index)
{
    struct simulation_fixture fixture;
    struct talus_estimate estimate;
    struct talus_error error = {0};
    simulation_fixture_init(&fixture, axes, 0.1, (const int64_t[3]){40, 40, 40});
    fixture.scene.solver.shape_index = shape_index;
    const size_t material =
        simulation_fixture_add_sample(&fixture, material_find("drucker_prager_cap"));
    double end[3];
    for (size_t axis = 0; axis < 3; axis++)
        end[axis] = 0.1 + size[axis];
    simulation_fixture_add_box(&fixture, material, (const double[3]){0.1, 0.1, 0.1}, end,
                               axes == 2 ? 4 : 2);
    assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct talus_simulation_state now;
    simulation_run_steps(simulation, 3);
    talus_simulation_get_state(simulation, &now);
    const double share = (double)now.memory_bytes / (double)estimate.memory_bytes;
    /* The rest is what doubles when it grows, and a last page of 2 MiB. */
    if (!(share <= 1 && share >= 0.6))
        fail_msg("%zu axes, %g m wide, %s: %zu of %llu bytes", axes, size[0],
                 shape_table[shape_index]->name, now.memory_bytes,
                 (unsigned long long)estimate.memory_bytes);
    talus_simulation_destroy(simulation);
}

static void test_memory(void **state)
{
    (void)state;
    static const double sizes[4][3] = {
        {2.0, 2.0, 2.0}, {3.8, 3.8, 0.4}, {0.8, 3.8, 0.8}, {3.6, 2.0, 3.0}};
    uint32_t reach = 0;
    for (size_t shape = 0; shape < shape_count; shape++) {
        if (shape_table[shape]->reach < reach)
            continue; /* the first of every reach */
        for (size_t axes = 2; axes <= 3; axes++) {
            for (size_t size = 0; size < 4; size++)
                check_memory(axes, sizes[size], shape);
        }
        reach = shape_table[shape]->reach + 1;
    }
}

static void test_over_critical_steps_are_refused(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_estimate estimate;
    struct talus_error error = {0};
    build(&fixture, 0);
    const double critical = 1.26 * 0.1 / sqrt(4000);
    fixture.scene.solver.time_step = 0.999 * critical;
    assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
    fixture.scene.solver.time_step = 1.001 * critical;
    assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_INVALID);
    assert_string_equal(error.code, "over_critical");
    assert_string_equal(error.pointer, "/solver/time_step");
    assert_close(estimate.critical_time_step, critical, 1e-12, critical);
    fixture.scene.solver.allow_unstable = true;
    memset(&error, 0, sizeof error);
    assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
}

/* The limit is that of the method, from the stability map; quadratic elements work in half cells.
 */
static void test_the_limit_is_that_of_the_method(void **state)
{
    (void)state;
    static const struct {
        const char *shape, *transfer;
        enum talus_stress_update update;
        double limit, cell;
    } methods[] = {
        {"bspline2", "flip", TALUS_STRESS_MODIFIED_LAST, 1.45, 0.1},
        {"bspline2", "apic", TALUS_STRESS_MODIFIED_LAST, 1.005, 0.1},
        {"quadratic", "flip", TALUS_STRESS_MODIFIED_LAST, 0.654, 0.05},
        {"quadratic", "flip", TALUS_STRESS_LAST, 0.43, 0.05},
        {"quadratic", "pic", TALUS_STRESS_FIRST, 0.624, 0.05},
    };
    for (size_t index = 0; index < LENGTH(methods); index++) {
        struct simulation_fixture fixture;
        struct talus_estimate estimate;
        struct talus_error error = {0};
        build(&fixture, 0);
        struct talus_solver_options *solver = &fixture.scene.solver;
        solver->shape_index = simulation_fixture_shape(methods[index].shape);
        while (strcmp(transfer_table[solver->transfer_index]->name, methods[index].transfer) != 0)
            solver->transfer_index++;
        solver->stress_update = methods[index].update;
        const double critical = methods[index].limit * methods[index].cell / sqrt(4000);
        solver->time_step = 0.999 * critical;
        assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
        assert_close(estimate.critical_time_step, critical, 1e-12, critical);
        solver->time_step = 1.001 * critical;
        assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error),
                         TALUS_INVALID);
        assert_string_equal(error.code, "over_critical");
    }
}

/* A fixed step that becomes critical because the body gets fast: one warning, no end. */
static void test_warned_once_when_it_becomes_critical(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_warning warning;
    build(&fixture, 0);
    fixture.scene.gravity[0] = 200;
    fixture.scene.solver.time_step = 0.97 * 1.26 * 0.1 / sqrt(4000);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    assert_false(talus_simulation_take_warning(simulation, &warning));
    size_t warnings = 0;
    double when = 0;
    for (size_t step = 0; step < 20; step++) {
        simulation_run_steps(simulation, 1);
        struct talus_simulation_state now;
        talus_simulation_get_state(simulation, &now);
        while (talus_simulation_take_warning(simulation, &warning)) {
            assert_string_equal(warning.code, "over_critical");
            assert_string_equal(warning.pointer, "/solver/time_step");
            warnings++;
            when = now.time;
        }
    }
    assert_int_equal(warnings, 1);
    /* 0.97 (c + v) = c at v = 1.96 m/s, after 9.8 ms. */
    assert_close(when, sqrt(4000) * (1 / 0.97 - 1) / 200, 1.01, fixture.scene.solver.time_step);
    talus_simulation_destroy(simulation);
}

static void test_ends_at_duration(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_simulation_state now;
    struct talus_error error = {0};
    build(&fixture, 0);
    fixture.scene.solver.time_step = 1e-3;
    fixture.scene.duration = 0.0105;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    simulation_run_steps(simulation, 10);
    talus_simulation_get_state(simulation, &now);
    assert_false(now.finished);
    assert_close(now.time_step, 5e-4, 1e-9, 1);
    assert_true(talus_simulation_is_nearest(simulation, 0.0102));
    assert_false(talus_simulation_is_nearest(simulation, 0.0103));
    simulation_run_steps(simulation, 1);
    talus_simulation_get_state(simulation, &now);
    assert_true(now.finished);
    assert_close(now.time, 0.0105, 1e-15, 1);
    assert_int_equal(now.step, 11);
    simulation_run_steps(simulation, 1); /* nothing happens any more */
    talus_simulation_get_state(simulation, &now);
    assert_int_equal(now.step, 11);
    /* Steering. */
    assert_int_equal(talus_simulation_set_duration(simulation, 0.01, &error), TALUS_INVALID);
    assert_int_equal(talus_simulation_set_duration(simulation, NAN, NULL), TALUS_INVALID);
    assert_int_equal(talus_simulation_set_duration(simulation, 0.012, NULL), TALUS_OK);
    simulation_run_steps(simulation, 2);
    talus_simulation_get_state(simulation, &now);
    assert_true(now.finished);
    assert_close(now.time, 0.012, 1e-15, 1);
    talus_simulation_destroy(simulation);
}

static void test_huge_scenes_are_estimated_without_memory(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_estimate estimate;
    struct talus_error error = {0};
    build(&fixture, 0);
    fixture.scene.axis_count = 3;
    fixture.scene.dimension = TALUS_SOLID;
    for (size_t axis = 0; axis < 3; axis++) {
        fixture.scene.grid.cell[axis] = 1e-3;
        fixture.scene.grid.cell_count[axis] = 100000;
        fixture.bodies[0].box_min[axis] = 0;
        fixture.bodies[0].box_max[axis] = 100;
        fixture.bodies[0].lattice_value[axis] = 2;
    }
    assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
    assert_true(estimate.particle_count >= (uint64_t)7e15);
    assert_true(estimate.memory_bytes / estimate.bytes_per_particle >= estimate.particle_count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_critical_step),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_over_critical_steps_are_refused),
        cmocka_unit_test(test_the_limit_is_that_of_the_method),
        cmocka_unit_test(test_warned_once_when_it_becomes_critical),
        cmocka_unit_test(test_ends_at_duration),
        cmocka_unit_test(test_huge_scenes_are_estimated_without_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

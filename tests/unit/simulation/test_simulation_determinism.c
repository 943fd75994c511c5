/* SPDX-License-Identifier: Apache-2.0 */
/* The same bits for any number of threads, and whether or not anybody looks. */
#include "shapes/shape.h"
#include "simulation_fixture.h"

/* A heap over many tiles that slides and falls apart. */
static void build(struct simulation_fixture *fixture, const struct material *material, size_t axes)
{
    static const int64_t count[3] = {48, 24, 8};
    static const double min[3] = {0.4, 0.2, 0.2}, max[3] = {2.4, 1.2, 0.3};
    simulation_fixture_init(fixture, axes, 0.1, count);
    const size_t index = simulation_fixture_add_sample(fixture, material);
    struct talus_body *body = simulation_fixture_add_box(fixture, index, min, max, 2);
    body->velocity[0] = 2.0;
    const size_t up = axes == 1 ? 0 : 1;
    fixture->scene.gravity[up] = -9.81;
    simulation_fixture_add_plane(fixture, "floor", up, 0.2, 1, "friction", 0.3);
    fixture->scene.solver.anti_locking = TALUS_CONTROL_CELL;
}

static void compare_threads(const struct simulation_fixture *fixture)
{
    struct talus_simulation *one = simulation_fixture_start(fixture, 1);
    struct talus_simulation *two = simulation_fixture_start(fixture, 2);
    assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(two));
    for (size_t turn = 0; turn < 2; turn++) {
        const uint64_t before = talus_simulation_state_hash(one);
        simulation_run_steps(one, 15);
        simulation_run_steps(two, 15);
        assert_true(talus_simulation_state_hash(one) != before);
        assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(two));
    }
    assert_true(simulation_metric(one, "energy_numerical") ==
                simulation_metric(two, "energy_numerical"));
    assert_true(simulation_metric(one, "reaction.floor.peak") ==
                simulation_metric(two, "reaction.floor.peak"));
    talus_simulation_destroy(one);
    talus_simulation_destroy(two);
}

static void test_one_and_two_threads(void **state)
{
    (void)state;
    for (size_t index = 0; index < material_count; index++) {
        for (size_t axes = 1; axes <= 3; axes++) {
            struct simulation_fixture fixture;
            build(&fixture, material_table[index], axes);
            const int update = (int)(index % TALUS_STRESS_UPDATE_COUNT);
            fixture.scene.solver.stress_update = (enum talus_stress_update)update;
            if (update == TALUS_STRESS_LAST) /* does not bear a body that moves through cells */
                fixture.bodies[0].velocity[0] = 0;
            compare_threads(&fixture);
        }
    }
}

static void test_one_and_two_threads_of_every_shape(void **state)
{
    (void)state;
    for (size_t shape = 0; shape < shape_count; shape++) {
        if (shape_table[shape]->may_lump_negative)
            continue; /* for small displacements only: test_quadratic.c */
        for (size_t axes = 1; axes <= 3; axes++) {
            struct simulation_fixture fixture;
            build(&fixture, material_find("linear_elastic"), axes);
            fixture.scene.solver.shape_index = shape;
            compare_threads(&fixture);
            fixture.scene.solver.stress_update = TALUS_STRESS_LAST;
            compare_threads(&fixture);
        }
    }
}

static void test_one_and_two_threads_of_every_fit(void **state)
{
    (void)state;
    for (int control = TALUS_CONTROL_CELL; control <= TALUS_CONTROL_HYBRID; control++) {
        for (int field = TALUS_FIT_VOLUMETRIC; field <= TALUS_FIT_FULL_CONSTANT_VOLUME; field++) {
            struct simulation_fixture fixture;
            build(&fixture, material_find("j2"), 2);
            fixture.scene.solver.anti_locking = (enum talus_anti_locking_control)control;
            fixture.scene.solver.anti_locking_field = (enum talus_anti_locking_field)field;
            fixture.scene.solver.shape_index = (size_t)field % shape_count;
            fixture.scene.solver.viscous_damping = 0.1;
            compare_threads(&fixture);
        }
    }
}

/* Everything that can be read, after every step. */
static void look(struct talus_simulation *simulation, double *row)
{
    size_t count = 0;
    talus_simulation_sample(simulation, row);
    assert_non_null(talus_simulation_checkpoint(simulation, &count));
    assert_non_null(talus_simulation_metrics(simulation, &count));
    const size_t particles = simulation_particle_count(simulation);
    double *position = calloc(3 * particles, sizeof *position);
    assert_non_null(position);
    talus_simulation_read_positions(simulation, position);
    free(position);
    free(simulation_field(simulation, TALUS_FIELD_STRESS, 6));
    (void)talus_simulation_read_nodes(simulation, NULL, NULL, NULL, NULL, NULL);
}

static void test_looking_changes_nothing(void **state)
{
    (void)state;
    for (size_t index = 0; index < material_count; index++) {
        struct simulation_fixture fixture;
        build(&fixture, material_table[index], 2);
        if (index % 2 == 1)
            fixture.scene.solver.stress_update = TALUS_STRESS_FIRST;
        fixture.scene.output.frame_fields = 1u << TALUS_FIELD_STRESS;
        struct talus_simulation *watched = simulation_fixture_start(&fixture, 1);
        struct talus_simulation *alone = simulation_fixture_start(&fixture, 1);
        size_t columns = 0;
        (void)talus_simulation_columns(watched, &columns);
        double *row = calloc(columns, sizeof *row);
        assert_non_null(row);
        for (size_t step = 0; step < 70; step++) {
            look(watched, row);
            simulation_run_steps(watched, 1);
            simulation_run_steps(alone, 1);
            assert_true(talus_simulation_state_hash(watched) == talus_simulation_state_hash(alone));
        }
        static const char *const metrics[] = {"energy_error", "energy_numerical", "momentum_error",
                                              "reaction.floor.peak", "reaction.floor.peak_time"};
        for (size_t k = 0; k < LENGTH(metrics); k++)
            assert_true(simulation_metric(watched, metrics[k]) ==
                        simulation_metric(alone, metrics[k]));
        free(row);
        talus_simulation_destroy(watched);
        talus_simulation_destroy(alone);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_and_two_threads),
        cmocka_unit_test(test_one_and_two_threads_of_every_shape),
        cmocka_unit_test(test_one_and_two_threads_of_every_fit),
        cmocka_unit_test(test_looking_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

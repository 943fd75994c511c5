/* SPDX-License-Identifier: Apache-2.0 */
/* Quadratic elements: weights of both halves, bodies that vibrate in place, and those whose lumped
 * masses go wrong. */
#include "shapes/shape.h"
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"

/* N of node 0, 1, 2 of the element at xi in -1..1. */
static double lagrange(int node, double xi)
{
    return node == 0 ? xi * (xi - 1) / 2 : node == 1 ? 1 - xi * xi : xi * (xi + 1) / 2;
}

static void build(struct simulation_fixture *fixture, size_t axes, const double min[3],
                  const double max[3])
{
    static const int64_t count[3] = {12, 12, 12};
    simulation_fixture_init(fixture, axes, 0.1, count);
    const size_t material = simulation_fixture_add_sample(fixture, material_find("linear_elastic"));
    simulation_fixture_add_box(fixture, material, min, max, 2);
    fixture->scene.solver.shape_index = simulation_fixture_shape("quadratic");
}

static double node_mass(const struct sparse_grid *grid, const int32_t node[3])
{
    const int32_t x = node[0] / LANE_COUNT * LANE_COUNT;
    const uint32_t block =
        block_map_find(&grid->nodes.map, block_key(x / LANE_COUNT, node[1], node[2]));
    return block == BLOCK_NONE
               ? 0
               : node_values(&grid->nodes, block, grid->nodes.layout.mass)[node[0] - x];
}

/* The lumped masses of a block of two full cells an axis are those of the definition, at every node
 * of its elements and at none around them. */
static void test_masses_follow_the_definition(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        struct simulation_fixture fixture;
        build(&fixture, axes, (const double[3]){0.3, 0.3, 0.3}, (const double[3]){0.5, 0.5, 0.5});
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        const struct run *run = &simulation->run;
        double line[8] = {0};
        for (int element = 0; element < 2; element++) {
            for (int node = 0; node < 3; node++)
                line[1 + 2 * element + node] += lagrange(node, -0.5) + lagrange(node, 0.5);
        }
        for (int32_t place = 0; place < 512; place++) {
            const int32_t offset[3] = {place % 8, place / 8 % 8, place / 64};
            int32_t node[3] = {0, 0, 0};
            double expected = run->least_mass;
            for (size_t axis = 0; axis < axes; axis++) {
                node[axis] = 5 + offset[axis]; /* the block begins at node 6 */
                expected *= line[offset[axis]];
            }
            assert_close(node_mass(&run->grid, node), expected, 64 * (double)REAL_EPSILON,
                         run->least_mass);
        }
        talus_simulation_destroy(simulation);
    }
}

/* A block that stands on a floor and vibrates under its weight: the books close, and it has the
 * same bits with one and two threads, and after a checkpoint. */
static void test_vibration(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        struct simulation_fixture fixture;
        build(&fixture, axes, (const double[3]){0.2, 0.2, 0.2}, (const double[3]){0.6, 0.5, 0.4});
        fixture.scene.gravity[0] = -9.81;
        simulation_fixture_add_plane(&fixture, "floor", 0, 0.2, 1, "stick", 0);
        struct talus_simulation *one = simulation_fixture_start(&fixture, 1);
        struct talus_simulation *two = simulation_fixture_start(&fixture, 2);
        simulation_run_steps(one, 40);
        simulation_run_steps(two, 40);
        assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(two));
        struct talus_simulation *again = NULL;
        struct talus_error error = {0};
        const struct talus_simulation_options options = {.threads = 1};
        size_t count = 0;
        const struct talus_blob *blobs = talus_simulation_checkpoint(one, &count);
        assert_non_null(blobs);
        assert_int_equal(
            talus_simulation_restore(&fixture.scene, &options, blobs, count, &again, &error),
            TALUS_OK);
        simulation_run_steps(one, 20);
        simulation_run_steps(again, 20);
        assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(again));
        assert_true(simulation_metric(one, "momentum_error") < 60 * (double)REAL_EPSILON);
        assert_true(simulation_metric(one, "energy_error") < 0.01);
        talus_simulation_destroy(one);
        talus_simulation_destroy(two);
        talus_simulation_destroy(again);
    }
}

/* Particles at xi = 1/4 and 3/4 of one cell: the lower node has -3/32 of their mass, -3/16 of one
 * of them. */
static void test_half_a_cell_is_refused(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_simulation *simulation = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = 1};
    build(&fixture, 1, (const double[3]){0.35, 0, 0}, (const double[3]){0.4, 0, 0});
    fixture.bodies[0].lattice = TALUS_LATTICE_COUNT;
    fixture.bodies[0].lattice_value[0] = 2;
    assert_int_equal(talus_simulation_create(&fixture.scene, &options, &simulation, &error),
                     TALUS_INVALID);
    assert_null(simulation);
    assert_string_equal(error.code, "negative_mass");
    assert_string_equal(error.pointer, "/solver/shape");
    assert_non_null(strstr(error.text, "(0.3, 0, 0) has -0.18"));
}

/* A body that flies into new cells ends as unstable, with the same words. */
static void test_motion_ends_the_run(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_error error = {0};
    build(&fixture, 2, (const double[3]){0.3, 0.3, 0}, (const double[3]){0.6, 0.6, 0});
    fixture.bodies[0].velocity[0] = 5;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    enum talus_status status = TALUS_OK;
    struct talus_simulation_state now = {.finished = false};
    while (status == TALUS_OK && !now.finished) {
        status = talus_simulation_step(simulation, &error);
        talus_simulation_get_clock(simulation, &now);
    }
    assert_int_equal(status, TALUS_UNSTABLE);
    assert_string_equal(error.code, "negative_mass");
    /* The edge particles, a quarter of a cell from the edge, have gone on into the next. */
    assert_true(now.time * 5 < 0.05);
    talus_simulation_destroy(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_masses_follow_the_definition),
        cmocka_unit_test(test_vibration),
        cmocka_unit_test(test_half_a_cell_is_refused),
        cmocka_unit_test(test_motion_ends_the_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

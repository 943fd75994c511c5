/* SPDX-License-Identifier: Apache-2.0 */
/* Front smoothing: which particles, what becomes of them; momentum, threads, checkpoints. */
#include "explicit/front_smoothing.h"
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.3}};

static struct talus_body *build(struct simulation_fixture *fixture, size_t axes, double min,
                                double max, enum talus_front_reading reading)
{
    static const int64_t count[3] = {20, 20, 20};
    const double low[3] = {min, min, min}, high[3] = {max, max, max};
    simulation_fixture_init(fixture, axes, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    fixture->scene.solver.stress_update = TALUS_STRESS_LAST;
    fixture->scene.solver.front_threshold = 0.25;
    fixture->scene.solver.front_reading = reading;
    fixture->scene.solver.time_step = 2e-4;
    fixture->scene.energy_growth_limit = 1;
    return simulation_fixture_add_box(fixture, material, low, high, 2);
}

/* Particles that are marked in the state at the start, [id] in `marked`; nothing may move. */
static size_t find_marked(const struct simulation_fixture *fixture, bool *marked)
{
    struct talus_simulation *simulation = simulation_fixture_start(fixture, 1);
    struct run *run = &simulation->run;
    const struct shape_context context = run_shape_context(run, 0);
    size_t total = 0;
    simulation_run_steps(simulation, 1);
    for (size_t index = 0; index < run->grid.block_count; index++) {
        const struct particle_block *block = &run->grid.blocks[index];
        if (block->row_count == 0)
            continue;
        const bool any = front_find(run, &context, block, &run->scratch[0]);
        size_t found = 0;
        for (size_t slot = 0; slot < (size_t)block->row_count * LANE_COUNT; slot++) {
            const bool is_marked =
                block->id[slot] != PARTICLE_NONE && run->scratch[0].mean[slot] > 0;
            found += is_marked;
            if (is_marked && marked != NULL)
                marked[block->id[slot]] = true;
        }
        assert_true(any == (found > 0));
        total += found;
    }
    talus_simulation_destroy(simulation);
    return total;
}

/* [3 n] in order of id; the caller frees it. */
static double *positions_of(const struct talus_simulation *simulation)
{
    double *position = calloc(3 * simulation_particle_count(simulation), sizeof *position);
    assert_non_null(position);
    talus_simulation_read_positions(simulation, position);
    return position;
}

static double hat(double x, double node)
{
    return fmax(0, 1 - fabs(x - node) / 0.1);
}

/* A block whose edge lies within cells, against the sums over all particles. */
static void test_marks(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        struct simulation_fixture fixture;
        build(&fixture, axes, 0.53, 0.93, TALUS_FRONT_START_VELOCITY);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        double *position = positions_of(simulation);
        const size_t count = simulation_particle_count(simulation);
        bool *marked = calloc(count, sizeof *marked);
        assert_non_null(marked);
        const size_t total = find_marked(&fixture, marked);
        size_t expected = 0;
        for (size_t p = 0; p < count; p++) {
            bool alone = false;
            for (int corner = 0; corner < 1 << axes; corner++) {
                double node[3], fraction = 0;
                for (size_t axis = 0; axis < axes; axis++)
                    node[axis] = 0.1 * (floor(position[3 * p + axis] / 0.1) + (corner >> axis & 1));
                for (size_t q = 0; q < count; q++) {
                    double weight = 1;
                    for (size_t axis = 0; axis < axes; axis++)
                        weight *= 0.5 * hat(position[3 * q + axis], node[axis]);
                    fraction += weight;
                }
                alone = alone || fraction < 0.25;
            }
            assert_true(marked[p] == alone);
            expected += alone;
        }
        assert_int_equal(total, expected);
        if (axes == 1)
            assert_int_equal(total, 2); /* of 8: 0.225 of the first node, 0.025 of the last */
        assert_true(total < count);
        free(marked);
        free(position);
        talus_simulation_destroy(simulation);
    }
}

/* A block of whole cells: corner nodes have 1/8, edges 1/4; walls halve the support. */
static void test_corners_and_walls(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 3, 0.5, 0.9, TALUS_FRONT_START_VELOCITY);
    assert_int_equal(find_marked(&fixture, NULL), 8 * 8);
    simulation_fixture_add_plane(&fixture, "x", 0, 0.5, 1, "slip", 0);
    assert_int_equal(find_marked(&fixture, NULL), 4 * 8);
    simulation_fixture_add_plane(&fixture, "y", 1, 0.5, 1, "slip", 0);
    simulation_fixture_add_plane(&fixture, "z", 2, 0.5, 1, "slip", 0);
    assert_int_equal(find_marked(&fixture, NULL), 8);
    build(&fixture, 2, 0.5, 0.9, TALUS_FRONT_START_VELOCITY);
    assert_int_equal(find_marked(&fixture, NULL), 0);
    build(&fixture, 2, 0.5, 0.55, TALUS_FRONT_START_VELOCITY);
    assert_int_equal(find_marked(&fixture, NULL), 1);
}

/* A particle alone at rest under pressure, which pushes its nodes apart: with the velocity before
 * the step it does not strain. */
static void test_start_velocity(void **state)
{
    (void)state;
    for (int smooths = 0; smooths < 2; smooths++) {
        struct simulation_fixture fixture;
        struct talus_body *body = build(&fixture, 2, 0.5, 0.55, TALUS_FRONT_START_VELOCITY);
        body->stress[0] = body->stress[1] = -1e4;
        body->initial_stress = TALUS_INITIAL_GIVEN;
        fixture.scene.solver.front_threshold = smooths ? 0.25 : 0;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        simulation_run_steps(simulation, 1);
        double *volume = simulation_field(simulation, TALUS_FIELD_VOLUME, 1);
        if (smooths)
            assert_close(volume[0], 0.0025, 8 * (double)REAL_EPSILON, 0.0025);
        else /* dt^2 p sum G^2 / (rho N) = 2.13e-4 an axis */
            assert_true(volume[0] > 0.0025 * 1.0004);
        free(volume);
        talus_simulation_destroy(simulation);
    }
}

/* It moves by the velocity that it had, and takes the new one along. */
static void test_free_flight(void **state)
{
    (void)state;
    for (int order = 0; order <= TALUS_STRESS_LAST; order++) {
        struct simulation_fixture fixture;
        struct talus_body *body = build(&fixture, 2, 0.5, 0.55, TALUS_FRONT_FREE_FLIGHT);
        body->velocity[0] = 1;
        fixture.scene.gravity[1] = -10;
        fixture.scene.solver.stress_update = (enum talus_stress_update)order;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        double y = 0.525, speed = 0;
        for (int step = 0; step < 20; step++) {
            simulation_run_steps(simulation, 1);
            y += 2e-4 * speed;
            speed -= 10 * 2e-4;
            double *position = positions_of(simulation);
            double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
            assert_close(position[0], 0.525 + 2e-4 * (step + 1), 100 * (double)REAL_EPSILON, 1);
            assert_close(position[1], y, 100 * (double)REAL_EPSILON, 1);
            assert_close(velocity[1], speed, 100 * (double)REAL_EPSILON, 1);
            free(position);
            free(velocity);
        }
        talus_simulation_destroy(simulation);
    }
}

static struct talus_simulation *resume(struct simulation_fixture *fixture,
                                       struct talus_simulation *simulation)
{
    struct talus_simulation *again = NULL;
    struct talus_error error = {0};
    const struct talus_simulation_options options = {.threads = 1};
    size_t count = 0;
    const struct talus_blob *blobs = talus_simulation_checkpoint(simulation, &count);
    assert_non_null(blobs);
    assert_int_equal(
        talus_simulation_restore(&fixture->scene, &options, blobs, count, &again, &error),
        TALUS_OK);
    return again;
}

/* A block under pressure that crosses cells on all sides. */
static void test_momentum_threads_and_checkpoints(void **state)
{
    (void)state;
    for (int variant = 0; variant < 9; variant++) {
        /* last with both readings, modified_last with free flight */
        static const enum talus_stress_update orders[] = {TALUS_STRESS_LAST, TALUS_STRESS_LAST,
                                                          TALUS_STRESS_MODIFIED_LAST};
        const size_t axes = (size_t)variant % 3 + 1;
        struct simulation_fixture fixture;
        struct talus_body *body =
            build(&fixture, axes, 0.5255, 0.8255,
                  variant < 3 ? TALUS_FRONT_START_VELOCITY : TALUS_FRONT_FREE_FLIGHT);
        for (size_t axis = 0; axis < 3; axis++) {
            body->velocity[axis] = axis < axes ? 2 : 0;
            body->stress[axis] = -1e3;
        }
        body->initial_stress = TALUS_INITIAL_GIVEN;
        fixture.scene.solver.stress_update = orders[variant / 3];
        struct talus_simulation *one = simulation_fixture_start(&fixture, 1);
        struct talus_simulation *two = simulation_fixture_start(&fixture, 2);
        simulation_run_steps(one, 60);
        simulation_run_steps(two, 60);
        assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(two));
        struct talus_simulation *again = resume(&fixture, one);
        simulation_run_steps(one, 60);
        simulation_run_steps(again, 60);
        assert_true(talus_simulation_state_hash(one) == talus_simulation_state_hash(again));
        assert_true(simulation_metric(one, "momentum_error") <= 1e-13);
        assert_true(simulation_metric(one, "mass_error") <= 1e-14);
        fixture.scene.solver.front_threshold = 0;
        struct talus_simulation *plain = simulation_fixture_start(&fixture, 1);
        simulation_run_steps(plain, 120);
        assert_true(talus_simulation_state_hash(one) != talus_simulation_state_hash(plain));
        talus_simulation_destroy(one);
        talus_simulation_destroy(two);
        talus_simulation_destroy(again);
        talus_simulation_destroy(plain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_marks),
        cmocka_unit_test(test_corners_and_walls),
        cmocka_unit_test(test_start_velocity),
        cmocka_unit_test(test_free_flight),
        cmocka_unit_test(test_momentum_threads_and_checkpoints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

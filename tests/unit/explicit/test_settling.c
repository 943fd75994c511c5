/* SPDX-License-Identifier: Apache-2.0 */
/* Settling before t = 0: comes to rest, counts for nothing, and can be interrupted. */
#include "simulation/simulation_private.h"
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.25}};

/* A column of 0.4 x 1 m under its weight of 4000 N/m, stress-free at first, with a ram beside it
 * that would be through it by the time it has settled. */
static void build(struct simulation_fixture *fixture, enum talus_stress_update order)
{
    static const int64_t count[3] = {40, 20, 1};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    simulation_fixture_add_box(fixture, material, (double[3]){0.6, 0.5}, (double[3]){1.0, 1.5}, 2);
    fixture->scene.gravity[1] = -10;
    simulation_fixture_add_plane(fixture, "floor", 1, 0.5, 1, "slip", 0);
    struct talus_boundary *ram =
        simulation_fixture_add_plane(fixture, "ram", 0, 0.3, 1, "velocity", 0);
    ram->prescribed = 1;
    ram->velocity[0] = 2;
    fixture->scene.solver.stress_update = order;
    fixture->scene.solver.courant = order == TALUS_STRESS_LAST ? 0.1 : 0.4;
    fixture->scene.solver.settle_time = 0.5;
    fixture->scene.solver.settle_damping = 20;
    fixture->scene.duration = 0.2;
    fixture->scene.output.frame_fields = 1u << TALUS_FIELD_DISPLACEMENT;
    struct talus_probe *probe = simulation_fixture_add_probe(fixture, "top", TALUS_PROBE_POINT);
    probe->at[0] = 0.8;
    probe->at[1] = 1.5;
    probe->field = TALUS_FIELD_DISPLACEMENT;
    probe->component = -1;
}

/* The settled first period of the column is 4 H / c = 0.12 s; 20 / s in 0.5 s leave exp(-10 / 2).
 */
static void test_it_is_at_rest_and_the_books_are_new(void **state)
{
    (void)state;
    for (int order = 0; order < TALUS_STRESS_UPDATE_COUNT; order++) {
        struct simulation_fixture fixture;
        build(&fixture, (enum talus_stress_update)order);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        struct talus_simulation_state now;
        talus_simulation_get_clock(simulation, &now);
        assert_true(now.time == -0.5 && !now.finished);
        size_t columns = 0;
        (void)talus_simulation_columns(simulation, &columns);
        double *row = calloc(columns, sizeof *row);
        assert_non_null(row);
        double fastest = 0;
        while (now.time < 0) {
            fastest = fmax(fastest, simulation->run.largest_speed);
            simulation_run_steps(simulation, 1);
            talus_simulation_get_clock(simulation, &now);
        }
        assert_true(now.time == 0);
        talus_simulation_sample(simulation, row);
        assert_true(row[0] == 0);
        assert_true(simulation->run.largest_speed < 0.02 * fastest);
        const size_t force = simulation_column(simulation, "reaction.floor.force.y");
        assert_close(row[force], -4000, 0.02, 4000);
        /* Settled by rho g H^2 / 2 E' = 0.0045 m or so, none of which shows. */
        assert_true(row[simulation_column(simulation, "probe.top.y")] == 0);
        assert_true(row[simulation_column(simulation, "energy.dissipated")] == 0);
        assert_true(simulation_metric(simulation, "reaction.floor.peak") == 0);
        while (!now.finished) {
            simulation_run_steps(simulation, 1);
            talus_simulation_get_clock(simulation, &now);
        }
        assert_true(simulation_metric(simulation, "momentum_error") < 1e-12);
        /* The ram started at t = 0: 0.4 m to the right in the end, 0.1 m into the column. */
        assert_close(simulation->run.walls.shapes[1].point[0], 0.7, 1e-12, 1);
        assert_true(simulation_metric(simulation, "reaction.ram.peak_time") > 0.1);
        assert_true(simulation_metric(simulation, "reaction.ram.peak") > 0);
        free(row);
        talus_simulation_destroy(simulation);
    }
}

static struct talus_simulation *restored(const struct simulation_fixture *fixture,
                                         struct talus_simulation *simulation)
{
    static const struct talus_simulation_options options = {.threads = 1};
    struct talus_error error = {.status = TALUS_OK};
    struct talus_simulation *copy = NULL;
    size_t count = 0;
    const struct talus_blob *blobs = talus_simulation_checkpoint(simulation, &count);
    assert_int_equal(
        talus_simulation_restore(&fixture->scene, &options, blobs, count, &copy, &error), TALUS_OK);
    return copy;
}

static void test_it_can_be_interrupted(void **state)
{
    (void)state;
    for (int order = 0; order < TALUS_STRESS_UPDATE_COUNT; order++) {
        struct simulation_fixture fixture;
        build(&fixture, (enum talus_stress_update)order);
        struct talus_simulation *whole = simulation_fixture_start(&fixture, 1);
        simulation_run_steps(whole, 57);
        struct talus_simulation *resumed = restored(&fixture, whole);
        struct talus_simulation_state now;
        talus_simulation_get_clock(resumed, &now);
        assert_true(now.time < 0);
        while (!now.finished) {
            simulation_run_steps(whole, 1);
            simulation_run_steps(resumed, 1);
            talus_simulation_get_clock(whole, &now);
        }
        assert_true(talus_simulation_state_hash(whole) == talus_simulation_state_hash(resumed));
        assert_true(simulation_metric(whole, "reaction.ram.peak") ==
                    simulation_metric(resumed, "reaction.ram.peak"));
        talus_simulation_destroy(whole);
        talus_simulation_destroy(resumed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_it_is_at_rest_and_the_books_are_new),
        cmocka_unit_test(test_it_can_be_interrupted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Particles that are taken out: mass, momentum and energy stay in the books. */
#include "simulation_fixture.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.25}};

/* A block that flies to the right under gravity; velocity 4 m/s, grid of 2 m. */
static void build(struct simulation_fixture *fixture, size_t axes)
{
    static const int64_t count[3] = {20, 20, 12};
    simulation_fixture_init(fixture, axes, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    struct talus_body *body = simulation_fixture_add_box(
        fixture, material, (double[3]){0.8, 1.0, 0.5}, (double[3]){1.3, 1.4, 0.7}, 2);
    body->velocity[0] = 4.0;
    if (axes > 1)
        fixture->scene.gravity[1] = -9.81;
}

static void check_books(struct talus_simulation *simulation, double initial_mass)
{
    struct talus_error error = {0};
    struct talus_simulation_state now;
    talus_simulation_get_state(simulation, &now);
    double *mass = simulation_field(simulation, TALUS_FIELD_MASS, 1), left = 0;
    for (size_t k = 0; k < now.particle_count; k++)
        left += mass[k];
    free(mass);
    assert_close(left + now.eliminated_mass, initial_mass, 1e-13, initial_mass);
    assert_true(simulation_metric(simulation, "mass_error") <= 1e-13);
    assert_true(simulation_metric(simulation, "momentum_error") <= 1e-12);
    assert_true(simulation_metric(simulation, "energy_error") <= 1e-6);
    assert_true(fabs(simulation_metric(simulation, "energy_numerical")) <= 1e-3);
    assert_close(simulation_metric(simulation, "eliminated_mass"), now.eliminated_mass, 0, 1);
    if (talus_simulation_audit(simulation, &error) != TALUS_OK)
        fail_msg("audit: %s", error.text);
}

static void test_boundary_books_what_it_takes(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        struct simulation_fixture fixture;
        build(&fixture, axes);
        simulation_fixture_add_plane(&fixture, "sink", 0, 1.47, -1, "eliminate", 0);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        const double volumes[3] = {0.5, 0.2, 0.04};
        size_t steps = 0;
        struct talus_simulation_state now;
        do {
            simulation_run_steps(simulation, 1);
            talus_simulation_get_state(simulation, &now);
            double *position = calloc(3 * now.particle_count + 1, sizeof *position);
            assert_non_null(position);
            talus_simulation_read_positions(simulation, position);
            for (size_t k = 0; k < now.particle_count; k++)
                assert_true(position[3 * k] <= 1.47); /* nobody is left behind the plane */
            free(position);
            if (steps++ % 20 == 0)
                check_books(simulation, 1000 * volumes[axes - 1]);
        } while (now.time < 0.12);
        /* 1.3 m + 4 m/s x 0.12 s - 1.47 m: 0.31 m of 0.5 m are gone. */
        assert_close(now.eliminated_mass / (1000 * volumes[axes - 1]), 0.31 / 0.5, 0.051, 1);
        check_books(simulation, 1000 * volumes[axes - 1]);
        talus_simulation_destroy(simulation);
    }
}

static void test_box_and_face_take_only_what_is_in_them(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 2);
    fixture.scene.gravity[1] = 0;
    simulation_fixture_add_obstacle(&fixture, "hole", (double[3]){1.5, 1.2}, (double[3]){1.7, 1.6},
                                    "eliminate", 0);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct talus_simulation_state now;
    do {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_state(simulation, &now);
    } while (now.time < 0.14);
    /* The upper half hits the hole; its particles are faster than a hole is wide. */
    double *position = calloc(3 * now.particle_count + 1, sizeof *position);
    assert_non_null(position);
    talus_simulation_read_positions(simulation, position);
    size_t lower = 0;
    for (size_t k = 0; k < now.particle_count; k++) {
        const bool in_hole = position[3 * k] >= 1.5 && position[3 * k] <= 1.7 &&
                             position[3 * k + 1] >= 1.2 && position[3 * k + 1] <= 1.6;
        assert_false(in_hole);
        lower += position[3 * k + 1] < 1.2;
    }
    free(position);
    assert_int_equal(lower, 40);
    assert_true(now.particle_count < 70);
    check_books(simulation, 200);
    talus_simulation_destroy(simulation);
}

static void test_only_its_own_body(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 2);
    fixture.scene.gravity[1] = 0;
    simulation_fixture_add_box(&fixture, 0, (double[3]){0.8, 0.3}, (double[3]){1.3, 0.5}, 2)
        ->velocity[0] = 4.0;
    simulation_fixture_add_plane(&fixture, "sink", 0, 1.4, -1, "eliminate", 0)->body_index = 1;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct talus_simulation_state now;
    do {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_state(simulation, &now);
    } while (now.time < 0.15);
    assert_int_equal(now.particle_count, 80);
    assert_int_equal(now.initial_particle_count, 120);
    check_books(simulation, 300);
    talus_simulation_destroy(simulation);
}

/* The share of the mass that has left decides. */
static void test_outside(void **state)
{
    (void)state;
    for (int limited = 0; limited < 2; limited++) {
        struct simulation_fixture fixture;
        struct talus_error error = {0};
        enum talus_status status = TALUS_OK;
        build(&fixture, 2);
        fixture.scene.grid.outside = TALUS_OUTSIDE_ELIMINATE;
        fixture.scene.grid.outside_mass_limit = limited ? 0.29 : 1.0;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        struct talus_simulation_state now;
        do {
            status = talus_simulation_step(simulation, &error);
            talus_simulation_get_state(simulation, &now);
            if (status == TALUS_OK && limited)
                assert_true(now.eliminated_mass <= 0.29 * 200);
        } while (status == TALUS_OK && now.time < 0.26);
        if (limited) {
            assert_int_equal(status, TALUS_UNSTABLE);
            assert_string_equal(error.code, "outside_mass");
            assert_string_equal(error.pointer, "/grid/outside_mass_limit");
            assert_true(now.eliminated_mass > 0.29 * 200);
        } else {
            assert_int_equal(status, TALUS_OK);
            assert_true(now.eliminated_mass > 0.5 * 200);
            check_books(simulation, 200);
        }
        talus_simulation_destroy(simulation);
    }
}

static void test_everything_may_leave(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture, 2);
    simulation_fixture_add_plane(&fixture, "sink", 0, 1.4, -1, "eliminate", 0);
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct talus_simulation_state now;
    do {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_state(simulation, &now);
    } while (now.time < 0.2);
    assert_int_equal(now.particle_count, 0);
    assert_close(now.eliminated_mass, 200, 1e-12, 200);
    check_books(simulation, 200);
    size_t columns = 0;
    (void)talus_simulation_columns(simulation, &columns);
    double *row = calloc(columns, sizeof *row);
    assert_non_null(row);
    talus_simulation_sample(simulation, row);
    for (size_t index = 0; index < columns; index++)
        assert_true(isfinite(row[index]));
    free(row);
    talus_simulation_destroy(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_boundary_books_what_it_takes),
        cmocka_unit_test(test_box_and_face_take_only_what_is_in_them),
        cmocka_unit_test(test_only_its_own_body),
        cmocka_unit_test(test_outside),
        cmocka_unit_test(test_everything_may_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

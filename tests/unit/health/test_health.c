/* SPDX-License-Identifier: Apache-2.0 */
/* What makes a run unstable is found within the step, and named. */
#include "simulation_fixture.h"
#include "state/particles.h"

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.25}};

/* A block in free space that moves with a velocity. */
static void build_block(struct simulation_fixture *fixture, size_t axes, double velocity)
{
    static const int64_t count[3] = {40, 40, 40};
    simulation_fixture_init(fixture, axes, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    struct talus_body *body = simulation_fixture_add_box(
        fixture, material, (double[3]){1.0, 1.0, 1.0}, (double[3]){1.5, 1.3, 1.2}, 2);
    body->velocity[0] = velocity;
    fixture->scene.solver.allow_unstable = true;
}

/* Steps until health says no; returns how many were fine. Fails the test if nothing is found. */
static size_t steps_until_error(struct talus_simulation *simulation, size_t most,
                                struct talus_error *error)
{
    memset(error, 0, sizeof *error);
    for (size_t step = 0; step < most; step++) {
        const enum talus_status status = talus_simulation_step(simulation, error);
        if (status == TALUS_OK)
            continue;
        assert_int_equal(status, TALUS_UNSTABLE);
        struct talus_error again = {0};
        assert_int_equal(talus_simulation_step(simulation, &again), TALUS_UNSTABLE);
        assert_true(simulation_particle_count(simulation) > 0); /* can still be read */
        return step;
    }
    fail_msg("nothing was found in %zu steps", most);
    return most;
}

static void assert_named(const struct talus_error *error, const char *code)
{
    if (strcmp(error->code, code) != 0)
        fail_msg("code %s instead of %s: %s", error->code, code, error->text);
    if (strstr(error->text, "particle ") == NULL || strstr(error->text, "(body 'body')") == NULL ||
        strstr(error->text, " at (") == NULL || strstr(error->text, "t = ") == NULL ||
        strstr(error->text, "try ") == NULL)
        fail_msg("not named: %s", error->text);
}

static void test_too_fast(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_error error;
    build_block(&fixture, 2, 10.0);
    fixture.scene.solver.time_step = 0.02; /* 2 cells a step */
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    assert_int_equal(steps_until_error(simulation, 1, &error), 0);
    assert_named(&error, "too_fast");
    talus_simulation_destroy(simulation);
}

/* Two halves that close at 22 m/s: a step of 10 ms turns what lies between inside out. */
static void check_inverted(enum talus_strain strain)
{
    struct simulation_fixture fixture;
    struct talus_error error;
    build_block(&fixture, 2, 11.0);
    struct talus_body *other =
        simulation_fixture_add_box(&fixture, 0, (double[3]){1.5, 1.0}, (double[3]){2.0, 1.3}, 2);
    other->name = (char *)"body";
    other->velocity[0] = -11.0;
    fixture.scene.solver.time_step = 0.01;
    fixture.scene.solver.strain = strain;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    assert_int_equal(steps_until_error(simulation, 1, &error), 0);
    assert_named(&error, "inverted");
    talus_simulation_destroy(simulation);
}

static void test_inverted(void **state)
{
    (void)state;
    check_inverted(TALUS_STRAIN_FINITE);
    check_inverted(TALUS_STRAIN_SMALL);
}

/* Twice the critical step: energy grows, and is found long before numbers overflow. */
static void test_energy_growth(void **state)
{
    (void)state;
    for (int update = 0; update < TALUS_STRESS_UPDATE_COUNT; update++) {
        struct simulation_fixture fixture;
        struct talus_error error;
        struct talus_estimate estimate;
        build_block(&fixture, 2, 0);
        fixture.bodies[0].velocity[0] = 0.01;
        fixture.scene.solver.stress_update = (enum talus_stress_update)update;
        simulation_fixture_add_plane(&fixture, "wall", 0, 1.5, -1, "slip", 0);
        assert_int_equal(talus_simulation_estimate(&fixture.scene, &estimate, &error), TALUS_OK);
        fixture.scene.solver.time_step = 2.5 * estimate.critical_time_step;
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        const size_t steps = steps_until_error(simulation, 200, &error);
        assert_string_equal(error.code, "energy_growth");
        assert_non_null(strstr(error.text, "t = "));
        assert_true(steps < 100);
        double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
        for (size_t k = 0; k < 3 * simulation_particle_count(simulation); k++)
            assert_true(fabs(velocity[k]) < 1.0); /* 100 times the start */
        free(velocity);
        talus_simulation_destroy(simulation);
    }
}

/* Replaces one double among the particles of a checkpoint, by its present value. */
static void spoil(struct talus_blob *blobs, size_t count, double present, double value,
                  size_t which)
{
    for (size_t index = 0; index < count; index++) {
        if (strcmp(blobs[index].name, "particles") != 0)
            continue;
        double *numbers = (double *)(uintptr_t)blobs[index].data;
        size_t seen = 0;
        for (size_t k = 0; k < blobs[index].bytes / sizeof *numbers; k++) {
            if (numbers[k] == present && seen++ == which) {
                numbers[k] = value;
                return;
            }
        }
    }
    fail_msg("no value to spoil");
}

/* One velocity that is not finite, in a particle with no neighbours: wherever it lies in its block,
 * it must be found in the very next step. */
static void test_not_a_number(void **state)
{
    (void)state;
    static const double bad[2] = {NAN, INFINITY};
    for (size_t which = 0; which < 4; which++) {
        for (size_t kind = 0; kind < 2; kind++) {
            static const int64_t cells[3] = {40, 8, 1};
            struct simulation_fixture fixture;
            struct talus_error error = {0};
            struct talus_simulation *restored = NULL;
            const struct talus_simulation_options options = {.threads = 1};
            simulation_fixture_init(&fixture, 2, 0.1, cells);
            const size_t material = simulation_fixture_add_material(&fixture, "linear_elastic",
                                                                    elastic, LENGTH(elastic));
            /* Four specks three cells apart: each in a lane of its own. */
            for (size_t speck = 0; speck < 4; speck++) {
                const double x = 0.4 + 0.3 * (double)speck;
                struct talus_body *body = simulation_fixture_add_box(
                    &fixture, material, (double[3]){x, 0.4}, (double[3]){x + 0.1, 0.5}, 1);
                body->name = (char *)"body";
                body->velocity[0] = 0.125;
            }
            struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
            simulation_run_steps(simulation, 1);
            size_t count = 0;
            const struct talus_blob *blobs = talus_simulation_checkpoint(simulation, &count);
            assert_non_null(blobs);
            struct talus_blob *copy = calloc(count, sizeof *copy);
            assert_non_null(copy);
            memcpy(copy, blobs, count * sizeof *copy);
            spoil(copy, count, 0.125, bad[kind], which);
            assert_int_equal(
                talus_simulation_restore(&fixture.scene, &options, copy, count, &restored, &error),
                TALUS_OK);
            assert_int_equal(steps_until_error(restored, 1, &error), 0);
            assert_named(&error, "non_finite");
            free(copy);
            talus_simulation_destroy(restored);
            talus_simulation_destroy(simulation);
        }
    }
}

static void test_outside_is_named(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_error error;
    build_block(&fixture, 2, 5.0);
    fixture.scene.grid.cell_count[0] = 16;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    const size_t steps = steps_until_error(simulation, 2000, &error);
    assert_true(steps > 2);
    assert_string_equal(error.code, "outside");
    assert_string_equal(error.pointer, "/grid");
    assert_non_null(strstr(error.text, "(body 'body') at (1.6"));
    talus_simulation_destroy(simulation);
}

static void test_calm_runs_pass(void **state)
{
    (void)state;
    for (size_t axes = 1; axes <= 3; axes++) {
        struct simulation_fixture fixture;
        build_block(&fixture, axes, 1.0);
        struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
        simulation_run_steps(simulation, 100);
        talus_simulation_destroy(simulation);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_too_fast),         cmocka_unit_test(test_inverted),
        cmocka_unit_test(test_energy_growth),    cmocka_unit_test(test_not_a_number),
        cmocka_unit_test(test_outside_is_named), cmocka_unit_test(test_calm_runs_pass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Walls that move, rub along, come and go: impulses, work, and what the material does. */
#include "boundaries/boundary.h"
#include "shapes/shape.h"
#include "simulation_fixture.h"

#include <stdio.h>

static const struct setting elastic[] = {
    {"density", 1000}, {"young_modulus", 1e6}, {"poisson_ratio", 0.25}};

/* A block of 0.4 x 0.3 m, 120 kg/m, with its lower left corner at (0.6, 0.5) m, in cells of 0.1 m.
 */
static struct talus_body *build(struct simulation_fixture *fixture)
{
    static const int64_t count[3] = {40, 20, 1};
    simulation_fixture_init(fixture, 2, 0.1, count);
    const size_t material =
        simulation_fixture_add_material(fixture, "linear_elastic", elastic, LENGTH(elastic));
    return simulation_fixture_add_box(fixture, material, (double[3]){0.6, 0.5},
                                      (double[3]){1.0, 0.8}, 2);
}

static struct talus_boundary *move(struct talus_boundary *boundary, unsigned axes, double x,
                                   double y)
{
    boundary->prescribed = axes;
    boundary->velocity[0] = x;
    boundary->velocity[1] = y;
    return boundary;
}

/* What the samples must add up to, step by step. */
struct books {
    size_t force, external, columns;
    double *row, impulse[2], work, last;
};

static void books_open(struct books *books, const struct talus_simulation *simulation,
                       const char *boundary)
{
    char name[64];
    memset(books, 0, sizeof *books);
    (void)snprintf(name, sizeof name, "reaction.%s.force.x", boundary);
    (void)talus_simulation_columns(simulation, &books->columns);
    books->row = calloc(books->columns, sizeof *books->row);
    assert_non_null(books->row);
    books->force = simulation_column(simulation, name);
    books->external = simulation_column(simulation, "energy.external");
}

static void books_step(struct books *books, struct talus_simulation *simulation,
                       const double velocity[2])
{
    simulation_run_steps(simulation, 1);
    talus_simulation_sample(simulation, books->row);
    for (size_t axis = 0; axis < 2; axis++) {
        const double impulse = -books->row[books->force + axis] * (books->row[0] - books->last);
        books->impulse[axis] += impulse;
        books->work += impulse * velocity[axis];
    }
    books->last = books->row[0];
}

static double momentum(const struct talus_simulation *simulation, size_t axis)
{
    double *velocity = simulation_field(simulation, TALUS_FIELD_VELOCITY, 3);
    double *mass = simulation_field(simulation, TALUS_FIELD_MASS, 1), sum = 0;
    for (size_t k = 0; k < simulation_particle_count(simulation); k++)
        sum += mass[k] * velocity[3 * k + axis];
    free(velocity);
    free(mass);
    return sum;
}

/* A ram pushes a free block over ten cells: whatever the ordering and shape, the impulse of the ram
 * is the momentum of the block, its work is force times way and in the books, and the block ends up
 * with the ram's velocity. */
static void test_a_ram_takes_a_block_along(void **state)
{
    (void)state;
    static const double velocity[2] = {2.0, 0};
    for (size_t shape = 0; shape < shape_count; shape++) {
        if (shape_table[shape]->may_lump_negative)
            continue; /* for small displacements only: test_quadratic.c */
        for (int order = 0; order < TALUS_STRESS_UPDATE_COUNT; order++) {
            if (order == TALUS_STRESS_LAST && shape > 1)
                continue; /* ten times the steps, and the wall is the same for every shape */
            struct simulation_fixture fixture;
            build(&fixture);
            move(simulation_fixture_add_plane(&fixture, "ram", 0, 0.43, 1, "velocity", 0), 1,
                 velocity[0], 0);
            fixture.scene.solver.stress_update = (enum talus_stress_update)order;
            fixture.scene.solver.shape_index = shape;
            fixture.scene.solver.courant = 0.2;
            fixture.scene.solver.viscous_damping = 0.2;
            fixture.scene.duration = 0.5;
            if (fixture.scene.solver.stress_update == TALUS_STRESS_LAST)
                fixture.scene.solver.courant = 0.02; /* light nodes */
            struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
            struct books books;
            books_open(&books, simulation, "ram");
            struct talus_simulation_state now;
            do {
                books_step(&books, simulation, velocity);
                talus_simulation_get_clock(simulation, &now);
                /* Nodes lighter than 1e-11 of a particle carry no force. */
                assert_close(momentum(simulation, 0), books.impulse[0], 1e-10, 240);
                assert_close(books.row[books.external], books.work, 1e-11, 480);
            } while (!now.finished);
            assert_true(simulation_metric(simulation, "momentum_error") < 1e-10);
            /* `last` gains energy at edges that change cells. */
            assert_true(order == TALUS_STRESS_LAST ||
                        simulation_metric(simulation, "energy_error") < 0.01);
            /* Caught after 0.1 s at the latest, thrown off at up to twice the speed if nothing were
             * lost; the wall takes the impact itself away. */
            assert_true(momentum(simulation, 0) > 0.9 * 240);
            assert_true(momentum(simulation, 0) < 2.0 * 240);
            free(books.row);
            talus_simulation_destroy(simulation);
        }
    }
}

/* A body that moves with its walls feels none of them, whatever lines they hop over. */
static void test_walls_that_move_along_are_not_felt(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    struct talus_body *body = build(&fixture);
    body->velocity[0] = 3.0;
    move(simulation_fixture_add_plane(&fixture, "behind", 0, 0.6, 1, "velocity", 0), 1, 3.0, 0);
    move(simulation_fixture_add_plane(&fixture, "ahead", 0, 1.0, -1, "velocity", 0), 3, 3.0, 0);
    move(simulation_fixture_add_obstacle(&fixture, "below", (double[3]){0.2, 0.2},
                                         (double[3]){1.1, 0.5}, "velocity", 0),
         3, 3.0, 0);
    fixture.scene.duration = 0.4;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct talus_simulation_state now;
    do {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_clock(simulation, &now);
    } while (!now.finished);
    /* 120 kg at 3 m/s in a step of about 1 ms would be 3e5 N. */
    assert_true(simulation_metric(simulation, "reaction.behind.peak") < 1e-7);
    assert_true(simulation_metric(simulation, "reaction.ahead.peak") < 1e-7);
    assert_true(simulation_metric(simulation, "reaction.below.peak") < 1e-7);
    assert_close(momentum(simulation, 0), 360, 1e-12, 360);
    talus_simulation_destroy(simulation);
}

/* A column of 1 m between a floor and a piston that comes down slowly by 0.1 m: at the end the
 * stress is the constrained modulus, K + 4 G / 3 = 1.2e6 Pa, times the logarithmic strain, over the
 * volume that is left, and the work is what the column stores. */
static void test_slow_compression(void **state)
{
    (void)state;
    static double times[3] = {0, 1.0, 2.0}, speeds[3] = {0, -0.1, 0};
    struct simulation_fixture fixture;
    build(&fixture);
    fixture.bodies[0].box_max[1] = 1.5;
    fixture.scene.solver.shape_index =
        simulation_fixture_shape("bspline2"); /* particles change cells */
    struct talus_boundary *piston =
        simulation_fixture_add_plane(&fixture, "piston", 1, 1.5, -1, "velocity", 0);
    move(piston, 2, 0, 0)->velocity_tables[1] =
        (struct talus_time_table){.time = times, .value = speeds, .count = 3};
    simulation_fixture_add_plane(&fixture, "floor", 1, 0.5, 1, "slip", 0);
    simulation_fixture_add_plane(&fixture, "left", 0, 0.6, 1, "slip", 0);
    simulation_fixture_add_plane(&fixture, "right", 0, 1.0, -1, "slip", 0);
    fixture.scene.solver.viscous_damping = 0.5;
    fixture.scene.duration = 2.0;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct books books;
    books_open(&books, simulation, "piston");
    struct talus_simulation_state now;
    do {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_clock(simulation, &now);
    } while (!now.finished);
    talus_simulation_sample(simulation, books.row);
    /* Half a cell at the piston, of ten, strains otherwise than the rest. */
    const double strain = log(0.9);
    const double stored = books.row[simulation_column(simulation, "energy.strain")];
    const size_t instant = simulation_column(simulation, "reaction.piston.instant.y");
    assert_close(books.row[instant], -1.2e6 * strain / 0.9 * 0.4, 0.05, 5e4);
    assert_close(stored, 0.5 * 1.2e6 * strain * strain * 0.4, 0.1, stored); /* a square */
    assert_close(books.row[books.external], stored, 0.02, stored);
    free(books.row);
    talus_simulation_destroy(simulation);
}

/* A belt drags with up to mu R: the block gains mu g t, then runs along. What the belt does beyond
 * its work on the block is friction. */
static void test_a_belt_drags(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture);
    fixture.scene.gravity[1] = -10;
    struct talus_boundary *belt = simulation_fixture_add_obstacle(
        &fixture, "belt", (double[3]){0.0, 0.2}, (double[3]){4.0, 0.5}, "velocity", 0);
    move(belt, 3, 1.0, 0);
    /* Moves along itself, off to the right: the far end is beyond the grid anyway. */
    for (size_t face = 0; face < 4; face++) {
        belt->faces[face].condition_index = 0;
        while (strcmp(boundary_table[belt->faces[face].condition_index]->name, "friction") != 0)
            belt->faces[face].condition_index++;
        belt->faces[face].friction_coefficient = 0.25;
    }
    belt->box_min[0] = -4;
    fixture.scene.solver.viscous_damping = 0.5;
    fixture.scene.duration = 0.2;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct books books;
    books_open(&books, simulation, "belt");
    struct talus_simulation_state now;
    do {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_clock(simulation, &now);
    } while (!now.finished);
    talus_simulation_sample(simulation, books.row);
    const size_t dissipated = simulation_column(simulation, "energy.dissipated");
    /* v = mu g t = 0.5 m/s; the landing changes the push a little. */
    assert_close(momentum(simulation, 0), 60, 0.05, 60);
    assert_close(books.row[books.external], momentum(simulation, 0) * 1.0, 1e-9, 60);
    /* Force times the mean sliding speed of 0.75 m/s; the rest is bulk damping of the landing. */
    assert_true(books.row[dissipated] > 0.95 * 45 && books.row[dissipated] < 1.15 * 45);
    talus_simulation_destroy(simulation);
    /* In the end it runs along. */
    fixture.scene.duration = 0.8;
    simulation = simulation_fixture_start(&fixture, 1);
    do {
        simulation_run_steps(simulation, 1);
        talus_simulation_get_clock(simulation, &now);
    } while (!now.finished);
    assert_close(momentum(simulation, 0), 120, 0.02, 120);
    free(books.row);
    talus_simulation_destroy(simulation);
}

/* A gate holds a block that is pushed by its own weight, and lets it go. */
static void test_a_gate_opens(void **state)
{
    (void)state;
    struct simulation_fixture fixture;
    build(&fixture);
    fixture.scene.gravity[1] = -10;
    struct talus_boundary *gate =
        simulation_fixture_add_plane(&fixture, "gate", 1, 0.5, 1, "slip", 0);
    gate->timed = true;
    gate->from = -INFINITY;
    gate->until = 0.2;
    fixture.scene.solver.viscous_damping = 0.5;
    fixture.scene.duration = 0.3;
    struct talus_simulation *simulation = simulation_fixture_start(&fixture, 1);
    struct books books;
    books_open(&books, simulation, "gate");
    double held = 0;
    struct talus_simulation_state now;
    do {
        books_step(&books, simulation, (double[2]){0, 0});
        if (books.last < 0.2)
            held = books.impulse[1];
        talus_simulation_get_clock(simulation, &now);
    } while (!now.finished);
    assert_close(held, 120 * 10 * 0.2, 0.1, 240); /* it bounces a little in between */
    assert_close(books.impulse[1], held, 0.02, 240);
    assert_close(momentum(simulation, 1), books.impulse[1] - 360, 1e-11, 360);
    assert_true(momentum(simulation, 1) < -0.5 * 120);
    free(books.row);
    talus_simulation_destroy(simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_ram_takes_a_block_along),
        cmocka_unit_test(test_walls_that_move_along_are_not_felt),
        cmocka_unit_test(test_slow_compression),
        cmocka_unit_test(test_a_belt_drags),
        cmocka_unit_test(test_a_gate_opens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

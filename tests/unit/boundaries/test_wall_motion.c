/* SPDX-License-Identifier: Apache-2.0 */
/* Boundaries that move or act in a part of the time: when their grid lines change, and to what.
 * Grid: cells of 0.5 m from 0 to (4, 3) m. */
#include "boundaries/boundary.h"
#include "simulation_fixture.h"

struct bench {
    struct simulation_fixture fixture;
    struct domain domain;
    struct wall_set walls;
};

static void bench_init(struct bench *bench)
{
    static const int64_t count[3] = {8, 6, 1};
    memset(bench, 0, sizeof *bench);
    simulation_fixture_init(&bench->fixture, 2, 0.5, count);
    bench->domain = (struct domain){
        .axis_count = 2, .cell = {0.5, 0.5, 1}, .inverse_cell = {2, 2, 1}, .cell_count = {8, 6, 1}};
}

static void bench_build(struct bench *bench)
{
    assert_int_equal(wall_set_create(&bench->walls, &bench->fixture.scene, &bench->domain), 0);
    wall_set_prepare(&bench->walls, &bench->fixture.scene, &bench->domain, 0, 0);
}

static struct talus_boundary *move(struct talus_boundary *boundary, double x, double y)
{
    boundary->prescribed = 3;
    boundary->velocity[0] = x;
    boundary->velocity[1] = y;
    return boundary;
}

static void step(struct bench *bench, double time, double length)
{
    wall_set_prepare(&bench->walls, &bench->fixture.scene, &bench->domain, time, length);
    wall_set_move(&bench->walls, &bench->fixture.scene, &bench->domain, length);
}

static size_t faces_at(const struct bench *bench, int32_t x, int32_t y)
{
    struct node_faces faces;
    wall_set_node_faces(&bench->walls, &bench->domain, (int32_t[3]){x, y, 0}, &faces);
    return faces.count;
}

static void test_a_plane_hops_from_line_to_line(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench);
    move(simulation_fixture_add_plane(&bench.fixture, "piston", 1, 3, -1, "velocity", 0), 0.3, -1);
    bench_build(&bench);
    const uint64_t changes = bench.walls.change_count;
    size_t hops = 0;
    int32_t line = 6;
    for (int turn = 0; turn < 20; turn++) {
        const uint64_t before = bench.walls.change_count;
        step(&bench, 0.1 * turn, 0.1);
        assert_close(bench.walls.faces[0].velocity[1], -1, 0, 1);
        /* Where it is at the start of the step, to the nearest line. */
        const int32_t now = (int32_t)lround((3 - 0.1 * turn) / 0.5);
        hops += bench.walls.change_count != before;
        assert_int_equal(bench.walls.change_count != before, now != line);
        line = now;
        assert_int_equal(faces_at(&bench, 3, line), 1);
        assert_int_equal(faces_at(&bench, 3, line - 1), 0);
        /* Sliding along itself changes nothing. */
        assert_close(wall_set_distance(&bench.walls, 0, (double[3]){1, 0}), 3 - 0.1 * (turn + 1),
                     1e-12, 1);
    }
    assert_int_equal(hops, 4);
    assert_int_equal(bench.walls.change_count, changes + hops);
    const int32_t below[3] = {2, line - 1, 0};
    assert_int_equal(wall_set_cell_folds(&bench.walls, &bench.domain, below), 8);
    wall_set_release(&bench.walls);
}

/* All sides of a box hop at once, so that it keeps its size on the grid. */
static void test_a_box_keeps_its_size(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench);
    move(simulation_fixture_add_obstacle(&bench.fixture, "ram", (double[3]){0.6, 1.1},
                                         (double[3]){1.3, 2.3}, "velocity", 0),
         1, 0);
    bench_build(&bench);
    const struct wall_shape *shape = bench.walls.shapes;
    const int32_t wide = shape->box_high[0] - shape->box_low[0];
    int32_t first = shape->box_low[0];
    for (int turn = 0; turn < 100; turn++) {
        step(&bench, 0.02 * turn, 0.02);
        assert_int_equal(shape->box_high[0] - shape->box_low[0], wide);
        assert_true(shape->box_low[0] == first || shape->box_low[0] == first + 1);
        first = shape->box_low[0];
    }
    assert_int_equal(shape->box_low[0], 5); /* from 0.6 to 2.6 */
    assert_close(shape->box_min[0], 2.6, 1e-12, 1);
    for (size_t face = 0; face < bench.walls.face_count; face++)
        assert_close(bench.walls.faces[face].velocity[0], 1, 0, 1);
    wall_set_release(&bench.walls);
}

static void test_what_stays_stays(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench);
    move(simulation_fixture_add_plane(&bench.fixture, "belt", 1, 0, 1, "velocity", 0), 2, 3)
        ->stays = true;
    bench_build(&bench);
    const uint64_t changes = bench.walls.change_count;
    for (int turn = 0; turn < 10; turn++)
        step(&bench, turn, 1);
    assert_int_equal(bench.walls.change_count, changes);
    assert_close(bench.walls.faces[0].velocity[0], 2, 0, 1);
    assert_close(wall_set_distance(&bench.walls, 0, (double[3]){1, 1}), 1, 1e-15, 1);
    wall_set_release(&bench.walls);
}

static void test_gates_open_and_close(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench);
    struct talus_boundary *gate =
        simulation_fixture_add_plane(&bench.fixture, "gate", 0, 2, -1, "slip", 0);
    gate->timed = true;
    gate->from = 1;
    gate->until = 2;
    struct talus_boundary *sink =
        simulation_fixture_add_plane(&bench.fixture, "sink", 1, 1, 1, "eliminate", 0);
    sink->timed = true;
    sink->from = -INFINITY;
    sink->until = 1.5;
    bench_build(&bench);
    const uint64_t changes = bench.walls.change_count;
    for (int turn = 0; turn < 30; turn++) {
        const double time = 0.1 * turn;
        step(&bench, time, 0.1);
        /* By the middle of the step. */
        assert_int_equal(faces_at(&bench, 5, 1), turn >= 10 && turn < 20);
        assert_int_equal(wall_set_eliminates(&bench.walls, (double[3]){1, 0.5}, 0), turn < 15);
        assert_int_equal(wall_set_may_eliminate(&bench.walls, (double[3]){0, 0}, (double[3]){1, 1}),
                         turn < 15);
        assert_int_equal(wall_set_cell_folds(&bench.walls, &bench.domain, (int32_t[3]){3, 1, 0}),
                         turn >= 10 && turn < 20 ? 2 : 0);
    }
    assert_int_equal(bench.walls.change_count, changes + 3);
    wall_set_release(&bench.walls);
}

/* The velocity of a step is the one at its end, and there is none before t = 0. */
static void test_velocities_follow_their_table(void **state)
{
    (void)state;
    static double times[2] = {0, 1}, values[2] = {0, 4};
    struct bench bench;
    bench_init(&bench);
    struct talus_boundary *wall =
        move(simulation_fixture_add_plane(&bench.fixture, "wall", 0, 0, 1, "velocity", 0), 9, 0.25);
    wall->velocity_tables[0] =
        (struct talus_time_table){.time = times, .value = values, .count = 2};
    bench_build(&bench);
    step(&bench, -0.5, 0.5);
    assert_close(bench.walls.faces[0].velocity[1], 0, 0, 1);
    double way = 0;
    for (int turn = 0; turn < 15; turn++) {
        step(&bench, 0.1 * turn, 0.1);
        const double speed = fmin(4, 0.4 * (turn + 1));
        assert_close(bench.walls.faces[0].velocity[0], speed, 1e-14, 1);
        assert_close(bench.walls.faces[0].velocity[1], 0.25, 0, 1);
        way += 0.1 * speed;
    }
    assert_close(bench.walls.shapes[0].point[0], way, 1e-13, 1);
    wall_set_release(&bench.walls);
}

/* What a checkpoint stores puts a new set into the same place. */
static void test_motions_are_restored(void **state)
{
    (void)state;
    struct bench bench;
    struct wall_motion motions[2];
    bench_init(&bench);
    move(simulation_fixture_add_plane(&bench.fixture, "piston", 1, 3, -1, "velocity", 0), 0, -1);
    struct talus_boundary *slope =
        move(simulation_fixture_add_plane(&bench.fixture, "slope", 1, 0, 1, "velocity", 0), 1, 1);
    slope->normal[0] = -0.6;
    slope->normal[1] = 0.8;
    bench_build(&bench);
    for (int turn = 0; turn < 7; turn++)
        step(&bench, 0.1 * turn, 0.1);
    const struct wall_set old = bench.walls;
    wall_set_get_motions(&old, motions);
    bench_build(&bench);
    wall_set_set_motions(&bench.walls, &bench.fixture.scene, &bench.domain, motions);
    for (size_t index = 0; index < 2; index++) {
        const struct wall_shape *one = &old.shapes[index], *other = &bench.walls.shapes[index];
        assert_memory_equal(one->point, other->point, sizeof one->point);
        assert_memory_equal(one->held_point, other->held_point, sizeof one->held_point);
        assert_int_equal(one->line, other->line);
    }
    struct wall_set copy = old;
    wall_set_release(&copy);
    wall_set_release(&bench.walls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_plane_hops_from_line_to_line),
        cmocka_unit_test(test_a_box_keeps_its_size),
        cmocka_unit_test(test_what_stays_stays),
        cmocka_unit_test(test_gates_open_and_close),
        cmocka_unit_test(test_velocities_follow_their_table),
        cmocka_unit_test(test_motions_are_restored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

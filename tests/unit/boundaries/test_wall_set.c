/* SPDX-License-Identifier: Apache-2.0 */
/* Which nodes a boundary holds and which areas they stand for. Grid: cells of 0.5 m from 0 to
 * (4, 3, 2) m. */
#include "boundaries/boundary.h"
#include "simulation_fixture.h"

enum { NX = 8, NY = 6, NZ = 4 };

struct bench {
    struct simulation_fixture fixture;
    struct domain domain;
    struct wall_set walls;
};

static void bench_init(struct bench *bench, size_t axes)
{
    static const int64_t count[3] = {NX, NY, NZ};
    memset(bench, 0, sizeof *bench);
    simulation_fixture_init(&bench->fixture, axes, 0.5, count);
    bench->domain.axis_count = axes;
    for (size_t axis = 0; axis < 3; axis++) {
        bench->domain.cell[axis] = axis < axes ? 0.5 : 1.0;
        bench->domain.inverse_cell[axis] = 1.0 / bench->domain.cell[axis];
        bench->domain.cell_count[axis] = axis < axes ? (int32_t)count[axis] : 1;
    }
}

static void bench_build(struct bench *bench)
{
    assert_int_equal(wall_set_create(&bench->walls, &bench->fixture.scene, &bench->domain), 0);
}

static struct node_faces at(const struct bench *bench, int32_t x, int32_t y, int32_t z)
{
    const int32_t node[3] = {x, y, z};
    struct node_faces faces;
    wall_set_node_faces(&bench->walls, &bench->domain, node, &faces);
    return faces;
}

/* Sum of the areas of all nodes on one face. */
static double total_area(const struct bench *bench, size_t face)
{
    double sum = 0;
    const size_t axes = bench->domain.axis_count;
    for (int32_t x = 0; x <= NX; x++) {
        for (int32_t y = 0; y <= (axes > 1 ? NY : 0); y++) {
            for (int32_t z = 0; z <= (axes > 2 ? NZ : 0); z++) {
                const struct node_faces faces = at(bench, x, y, z);
                for (size_t index = 0; index < faces.count; index++)
                    sum += faces.face[index] == face ? faces.area[index] : 0.0;
            }
        }
    }
    return sum;
}

static void test_plane_holds_what_is_on_it_and_behind(void **state)
{
    (void)state;
    for (int direction = -1; direction <= 1; direction += 2) {
        struct bench bench;
        bench_init(&bench, 3);
        simulation_fixture_add_plane(&bench.fixture, "wall", 1, 1.5, direction, "slip", 0);
        bench_build(&bench);
        for (int32_t y = 0; y <= NY; y++) {
            const struct node_faces faces = at(&bench, 2, y, 2);
            const int32_t depth = direction * (3 - y);
            assert_int_equal(faces.count, depth >= 0);
            if (faces.count > 0)
                assert_true(faces.area[0] == (depth == 0 ? 0.25 : 0.0));
        }
        /* The edges of the grid carry half, its corners a quarter. */
        assert_true(at(&bench, 0, 3, 2).area[0] == 0.125);
        assert_true(at(&bench, NX, 3, NZ).area[0] == 0.0625);
        assert_close(total_area(&bench, 0), 4.0 * 2.0, 1e-14, 1);
        wall_set_release(&bench.walls);
    }
}

static void test_source_rule_counts_whole_nodes(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2);
    simulation_fixture_add_plane(&bench.fixture, "floor", 1, 0, 1, "slip", 0)->area_source_rule =
        true;
    bench_build(&bench);
    assert_true(at(&bench, 0, 0, 0).area[0] == 0.5);
    assert_close(total_area(&bench, 0), 0.5 * (NX + 1), 1e-14, 1);
    wall_set_release(&bench.walls);
}

static void test_off_grid_planes_snap_to_the_nearest_line(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2);
    simulation_fixture_add_plane(&bench.fixture, "floor", 1, 0.7, 1, "slip", 0);
    simulation_fixture_add_plane(&bench.fixture, "wall", 0, 3.3, -1, "slip", 0);
    bench_build(&bench);
    assert_int_equal(at(&bench, 2, 2, 0).count, 0); /* 1.0 m */
    assert_int_equal(at(&bench, 2, 1, 0).count, 1); /* 0.5 m */
    assert_int_equal(at(&bench, 6, 3, 0).count, 0);
    assert_int_equal(at(&bench, 7, 3, 0).count, 1);
    assert_int_equal(at(&bench, 7, 1, 0).count, 2);
    wall_set_release(&bench.walls);
}

static void test_oblique_plane(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2);
    struct talus_boundary *slope =
        simulation_fixture_add_plane(&bench.fixture, "slope", 1, 0, 1, "slip", 0);
    slope->normal[0] = -0.6;
    slope->normal[1] = 0.8;
    slope->point[0] = 1.0;
    bench_build(&bench);
    double area = 0;
    for (int32_t x = 0; x <= NX; x++) {
        for (int32_t y = 0; y <= NY; y++) {
            const double distance = -0.6 * (0.5 * x - 1.0) + 0.8 * 0.5 * y;
            const struct node_faces faces = at(&bench, x, y, 0);
            /* Within half a cell along the steepest axis, and everything behind. */
            assert_int_equal(faces.count, distance <= 0.5 * 0.4);
            if (faces.count == 0)
                continue;
            assert_true((faces.area[0] > 0) == (distance > -0.5 * 0.4));
            area += x > 2 ? faces.area[0] : 0;
        }
    }
    /* From x = 1.25 m up to the edge of the grid: one node a column, cell width over cosine. */
    assert_close(area, 6 * 0.5 / 0.8, 1e-12, 1);
    wall_set_release(&bench.walls);
}

static void make_rectangle(struct talus_boundary *face, double size_1, double size_2)
{
    face->shape = TALUS_BOUNDARY_FACE;
    face->normal[0] = 1;
    face->normal[1] = face->normal[2] = 0;
    face->point[0] = 2;
    face->point[1] = 1.5;
    face->point[2] = 1;
    face->axis_1[2] = 1;
    face->axis_2[1] = -1;
    face->size[0] = size_1;
    face->size[1] = size_2;
}

static void test_rectangle_in_space(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 3);
    make_rectangle(simulation_fixture_add_plane(&bench.fixture, "gate", 0, 2, 1, "slip", 0), 1, 2);
    bench_build(&bench);
    for (int32_t x = 0; x <= NX; x++) {
        for (int32_t y = 0; y <= NY; y++) {
            for (int32_t z = 0; z <= NZ; z++) {
                const bool on = x == 4 && y >= 1 && y <= 5 && z >= 1 && z <= 3;
                const struct node_faces faces = at(&bench, x, y, z);
                assert_int_equal(faces.count, on);
                if (!on)
                    continue;
                const double share = (y == 1 || y == 5 ? 0.5 : 1) * (z == 1 || z == 3 ? 0.5 : 1);
                assert_close(faces.area[0], 0.25 * share, 1e-15, 1);
            }
        }
    }
    assert_close(total_area(&bench, 0), 2.0, 1e-14, 1);
    bench.fixture.boundaries[0].area_source_rule = true;
    wall_set_release(&bench.walls);
    bench_build(&bench);
    assert_close(total_area(&bench, 0), 0.25 * 15, 1e-14, 1);
    wall_set_release(&bench.walls);
}

static void test_box_faces_and_inside(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 3);
    simulation_fixture_add_obstacle(&bench.fixture, "block", (double[3]){1, 1, 0.5},
                                    (double[3]){2.5, 2, 1.5}, "slip", 0);
    bench_build(&bench);
    assert_int_equal(bench.walls.face_count, 7);
    static const double normals[6][3] = {{-1}, {1}, {0, -1}, {0, 1}, {0, 0, -1}, {0, 0, 1}};
    for (size_t face = 0; face < 6; face++)
        assert_memory_equal(bench.walls.faces[face].normal, normals[face], sizeof normals[face]);
    assert_int_equal(bench.walls.faces[6].face_index, -1);
    assert_string_equal(bench.walls.faces[6].condition->name, "stick");
    assert_int_equal(at(&bench, 1, 3, 2).count, 0);
    assert_int_equal(at(&bench, 3, 3, 2).face[0], 6); /* inside */
    assert_true(at(&bench, 3, 3, 2).area[0] == 0);
    const struct node_faces left = at(&bench, 2, 3, 2);
    assert_int_equal(left.count, 1);
    assert_int_equal(left.face[0], 0);
    assert_true(left.area[0] == 0.25);
    assert_int_equal(at(&bench, 5, 4, 2).count, 2);
    assert_int_equal(at(&bench, 5, 4, 3).count, 3);
    assert_true(at(&bench, 5, 4, 3).area[0] == 0.0625);
    static const double areas[6] = {1.0, 1.0, 1.5, 1.5, 1.5, 1.5};
    for (size_t face = 0; face < 6; face++)
        assert_close(total_area(&bench, face), areas[face], 1e-14, 1);
    wall_set_release(&bench.walls);
}

/* A box that stands on the floor of the grid and reaches to its side: no material can come from
 * there, so those faces do not exist and their nodes are inside. */
static void test_box_at_the_edge_of_the_grid(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2);
    simulation_fixture_add_obstacle(&bench.fixture, "block", (double[3]){3, 0},
                                    (double[3]){4.0, 1.0}, "slip", 0);
    bench_build(&bench);
    const struct node_faces foot = at(&bench, 6, 0, 0); /* only x_min */
    assert_int_equal(foot.count, 1);
    assert_int_equal(foot.face[0], 0);
    assert_int_equal(at(&bench, 7, 0, 0).face[0], 4); /* inside: held */
    assert_int_equal(at(&bench, 8, 1, 0).face[0], 4);
    const struct node_faces top = at(&bench, 8, 2, 0); /* only y_max */
    assert_int_equal(top.count, 1);
    assert_int_equal(top.face[0], 3);
    assert_int_equal(at(&bench, 6, 2, 0).count, 2);
    assert_close(total_area(&bench, 0), 1.0, 1e-15, 1);
    assert_close(total_area(&bench, 1), 0.0, 0, 1);
    assert_close(total_area(&bench, 2), 0.0, 0, 1);
    assert_close(total_area(&bench, 3), 1.0, 1e-15, 1);
    wall_set_release(&bench.walls);
}

static unsigned folds(const struct bench *bench, int32_t x, int32_t y, int32_t z)
{
    return wall_set_cell_folds(&bench->walls, &bench->domain, (int32_t[3]){x, y, z});
}

static void test_cells_beside_flat_walls_fold(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 3);
    simulation_fixture_add_plane(&bench.fixture, "floor", 1, 0.6, 1, "stick", 0); /* line 1 */
    simulation_fixture_add_plane(&bench.fixture, "roof", 1, 2.5, -1, "slip", 0);
    /* x = 2, y from 0.5 to 2.5, z from 0.5 to 1.5. */
    make_rectangle(simulation_fixture_add_plane(&bench.fixture, "gate", 0, 2, 1, "slip", 0), 1, 2);
    simulation_fixture_add_plane(&bench.fixture, "sink", 0, 0, 1, "eliminate", 0);
    struct talus_boundary *slope =
        simulation_fixture_add_plane(&bench.fixture, "slope", 2, 0, 1, "slip", 0);
    slope->normal[0] = 0.6;
    slope->normal[2] = 0.8;
    bench_build(&bench);
    for (int32_t x = 0; x < NX; x++) {
        for (int32_t y = 0; y < NY; y++) {
            for (int32_t z = 0; z < NZ; z++) {
                const bool gate = x == 4 && y >= 1 && y < 5 && z >= 1 && z < 3;
                assert_int_equal(folds(&bench, x, y, z),
                                 (gate ? 1u : 0u) | (y == 1 ? 4u : 0u) | (y == 4 ? 8u : 0u));
            }
        }
    }
    wall_set_release(&bench.walls);
}

static void test_cells_beside_a_box_fold(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2);
    /* On the floor of the grid: its lower face does not exist. */
    simulation_fixture_add_obstacle(&bench.fixture, "block", (double[3]){1, 0},
                                    (double[3]){2.5, 1.0}, "slip", 0);
    bench_build(&bench);
    for (int32_t x = 0; x < NX; x++) {
        for (int32_t y = 0; y < NY; y++)
            assert_int_equal(folds(&bench, x, y, 0), (x == 5 && y < 2 ? 1u : 0u) |
                                                         (x == 1 && y < 2 ? 2u : 0u) |
                                                         (y == 2 && x >= 2 && x < 5 ? 4u : 0u));
    }
    wall_set_release(&bench.walls);
}

static void test_eliminating_boundaries(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 2);
    simulation_fixture_add_plane(&bench.fixture, "sink", 1, 1.1, 1, "eliminate", 0);
    simulation_fixture_add_obstacle(&bench.fixture, "hole", (double[3]){3, 2},
                                    (double[3]){3.5, 2.5}, "eliminate", 0);
    bench_build(&bench);
    assert_int_equal(at(&bench, 2, 0, 0).count, 0); /* no node is held */
    assert_int_equal(at(&bench, 6, 4, 0).count, 0);
    assert_true(wall_set_eliminates(&bench.walls, (double[3]){1, 1.0999}, 0));
    assert_false(wall_set_eliminates(&bench.walls, (double[3]){1, 1.1001}, 0));
    assert_true(wall_set_eliminates(&bench.walls, (double[3]){3.2, 2.2}, 0));
    assert_false(wall_set_eliminates(&bench.walls, (double[3]){2.9, 2.2}, 0));
    assert_true(wall_set_may_eliminate(&bench.walls, (double[3]){0, 1}, (double[3]){2, 2}));
    wall_set_release(&bench.walls);
    bench.fixture.boundaries[0].body_index = 1;
    bench_build(&bench);
    assert_false(wall_set_eliminates(&bench.walls, (double[3]){1, 1}, 0));
    assert_true(wall_set_eliminates(&bench.walls, (double[3]){1, 1}, 1));
    wall_set_release(&bench.walls);
}

static void test_distances(void **state)
{
    (void)state;
    struct bench bench;
    bench_init(&bench, 3);
    simulation_fixture_add_plane(&bench.fixture, "floor", 1, 0.7, 1, "slip", 0);
    make_rectangle(simulation_fixture_add_plane(&bench.fixture, "gate", 0, 2, 1, "slip", 0), 1, 2);
    simulation_fixture_add_obstacle(&bench.fixture, "block", (double[3]){1, 1, 0.5},
                                    (double[3]){2, 2, 1.5}, "slip", 0);
    bench_build(&bench);
    const double point[3] = {3, 2.4, 1.2};
    assert_close(wall_set_distance(&bench.walls, 0, point), 1.7, 1e-15, 1);
    assert_close(wall_set_distance(&bench.walls, 1, point), 1.0, 1e-15, 1);
    assert_true(isinf(wall_set_distance(&bench.walls, 1, (double[3]){3, 2.6, 1.2})));
    assert_close(wall_set_distance(&bench.walls, 2, point), hypot(1, 0.4), 1e-15, 1);
    wall_set_release(&bench.walls);
}

/* A body of revolution: each node stands for a ring, and together they are the face. */
static void test_areas_of_revolution(void **state)
{
    (void)state;
    static const double pi = 3.14159265358979323846;
    struct bench bench;
    bench_init(&bench, 2);
    bench.domain.revolves = true;
    simulation_fixture_add_plane(&bench.fixture, "floor", 1, 0.0, 1, "slip", 0);
    simulation_fixture_add_plane(&bench.fixture, "tube", 0, 4.0, -1, "slip", 0);
    simulation_fixture_add_obstacle(&bench.fixture, "pile", (double[3]){1, 0}, (double[3]){2.5, 2},
                                    "slip", 0);
    struct talus_boundary *plate =
        simulation_fixture_add_plane(&bench.fixture, "plate", 1, 2.5, 1, "slip", 0);
    plate->shape = TALUS_BOUNDARY_FACE;
    plate->point[0] = 1.5;
    plate->axis_1[0] = 1;
    plate->size[0] = 3;
    bench_build(&bench);
    assert_close(at(&bench, 0, 0, 0).area[0], pi * 0.25 * 0.25, 1e-15, 1);
    assert_close(total_area(&bench, 0), pi * 16, 1e-14, 50);
    assert_close(total_area(&bench, 1), 2 * pi * 4 * 3, 1e-14, 50);
    assert_close(total_area(&bench, 3), 2 * pi * 2.5 * 2, 1e-14, 50);     /* x_max */
    assert_close(total_area(&bench, 5), pi * (2.5 * 2.5 - 1), 1e-14, 50); /* y_max */
    assert_close(total_area(&bench, 7), pi * 9, 1e-14, 50); /* behind the inside of the box */
    wall_set_release(&bench.walls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane_holds_what_is_on_it_and_behind),
        cmocka_unit_test(test_source_rule_counts_whole_nodes),
        cmocka_unit_test(test_off_grid_planes_snap_to_the_nearest_line),
        cmocka_unit_test(test_oblique_plane),
        cmocka_unit_test(test_rectangle_in_space),
        cmocka_unit_test(test_box_faces_and_inside),
        cmocka_unit_test(test_box_at_the_edge_of_the_grid),
        cmocka_unit_test(test_cells_beside_flat_walls_fold),
        cmocka_unit_test(test_cells_beside_a_box_fold),
        cmocka_unit_test(test_eliminating_boundaries),
        cmocka_unit_test(test_distances),
        cmocka_unit_test(test_areas_of_revolution),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

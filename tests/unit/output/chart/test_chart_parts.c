/* SPDX-License-Identifier: Apache-2.0 */
/* The parts of a chart that can be judged by numbers. */
#include "output/chart_mesh.h"
#include "output/chart_place.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void expect_ticks(bool logarithmic, double low, double high, int wanted, const char *names)
{
    const struct chart_scale scale = {logarithmic, low, high};
    struct chart_tick ticks[CHART_TICK_MAX];
    char text[400] = "";
    const size_t count = chart_ticks(&scale, wanted, ticks);
    for (size_t index = 0; index < count; index++) {
        assert_true(ticks[index].value >= low - 1e-5 * (high - low));
        assert_true(ticks[index].value <= high + 1e-5 * (high - low));
        if (!ticks[index].named)
            continue;
        (void)snprintf(text + strlen(text), 40, "%s%s", text[0] == '\0' ? "" : " ",
                       ticks[index].text);
        if (ticks[index].text[0] == '\0')
            (void)snprintf(text + strlen(text), 40, "10^%d", ticks[index].exponent);
    }
    assert_string_equal(text, names);
}

static void test_ticks(void **state)
{
    (void)state;
    expect_ticks(false, 0.0, 1.0, 5, "0.0 0.2 0.4 0.6 0.8 1.0");
    expect_ticks(false, -3.0, 4.9, 4, "-2 0 2 4");
    expect_ticks(false, 0.0, 4e6, 4, "0 1e6 2e6 3e6 4e6");
    expect_ticks(false, 1e-7, 4e-7, 3, "1e-7 2e-7 3e-7 4e-7");
    expect_ticks(true, 0.9, 110.0, 5, "1 10 100");
    expect_ticks(true, 0.9, 11.0, 9, "1 2 5 10");
    expect_ticks(true, 1e-6, 1e6, 4, "10^-5 1 10^5");
    expect_ticks(true, 2e5, 3e7, 6, "10^6 10^7");
    expect_ticks(true, 3.1, 3.9, 4, "3.2 3.4 3.6 3.8"); /* no decade within: as on a linear scale */
    expect_ticks(true, 1e-150, 1e150, 3, "10^-100 1 10^100");
}

static void test_scales(void **state)
{
    (void)state;
    for (int logarithmic = 0; logarithmic <= 1; logarithmic++) {
        struct chart_scale scale = {logarithmic != 0, INFINITY, -INFINITY};
        chart_scale_finish(&scale, 0.05); /* nothing */
        assert_true(scale.low < scale.high && isfinite(scale.low) && isfinite(scale.high));
        scale.low = scale.high = 7.0; /* one value lies in the middle */
        chart_scale_finish(&scale, 0.05);
        assert_true(fabs(chart_scale_share(&scale, 7.0) - 0.5) < 1e-12);
        scale.low = 1.0;
        scale.high = 100.0;
        chart_scale_finish(&scale, 0.05);
        assert_true(fabs(chart_scale_share(&scale, 1.0) - 0.05 / 1.1) < 1e-12);
        assert_true(fabs(chart_scale_share(&scale, 100.0) - 1.05 / 1.1) < 1e-12);
        assert_true(fabs(chart_scale_share(&scale, 10.0) - (logarithmic != 0 ? 0.5 : 0.1281)) <
                    1e-3);
    }
}

static double random_share(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 11) * 0x1p-53;
}

static double area_of(const struct chart_vertex *v, const size_t corners[3])
{
    const struct chart_vertex *a = &v[corners[0]], *b = &v[corners[1]], *c = &v[corners[2]];
    return 0.5 * ((b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x));
}

/* How far a vertex lies within the circle around a triangle; positive: inside (the sign of the
 * usual determinant). */
static double in_circle(const struct chart_vertex *v, const size_t corners[3], size_t vertex)
{
    double m[3][3];
    for (int row = 0; row < 3; row++) {
        m[row][0] = v[corners[row]].x - v[vertex].x;
        m[row][1] = v[corners[row]].y - v[vertex].y;
        m[row][2] = m[row][0] * m[row][0] + m[row][1] * m[row][1];
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* The triangles of points in a square with its corners cover the square once, and no circle around
 * one holds a fifth point. Tolerance: places are moved by 1e-7. */
static void test_triangles(void **state)
{
    enum { COUNT = 204 };
    struct chart_vertex vertices[COUNT] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    size_t triangles[2 * COUNT + 8][3];
    uint64_t random = 5;
    (void)state;
    for (int lattice = 0; lattice <= 1; lattice++) {
        for (size_t index = 4; index < COUNT; index++) {
            vertices[index].x = random_share(&random);
            vertices[index].y = random_share(&random);
            if (lattice == 1) { /* 14 x 14 inner points: all on circles with others */
                vertices[index].x = (1.0 + (double)((index - 4) % 14)) / 15.0;
                vertices[index].y = (1.0 + floor((double)(index - 4) / 14.0)) / 16.0;
            }
        }
        double area = 0.0;
        const size_t count = chart_triangulate(vertices, COUNT, triangles);
        assert_true(count > COUNT && count <= (size_t)2 * COUNT - 6);
        for (size_t index = 0; index < count; index++) {
            assert_true(area_of(vertices, triangles[index]) > -1e-7);
            area += area_of(vertices, triangles[index]);
            for (size_t vertex = 0; vertex < COUNT; vertex++)
                assert_true(in_circle(vertices, triangles[index], vertex) < 1e-6);
        }
        assert_true(fabs(area - 1.0) < 1e-4);
    }
}

static void test_triangles_of_a_line(void **state)
{
    struct chart_vertex vertices[20];
    size_t triangles[48][3];
    (void)state;
    for (size_t index = 0; index < 20; index++)
        vertices[index] = (struct chart_vertex){.x = (double)index / 20.0, .y = 0.3};
    assert_int_equal(chart_triangulate(vertices, 20, triangles), 0);
}

/* Area of the path that a context holds, by its corners. */
static double path_area(cairo_t *context)
{
    cairo_path_t *path = cairo_copy_path(context);
    double area = 0.0, first[2] = {0}, last[2] = {0};
    for (int index = 0; index < path->num_data; index += path->data[index].header.length) {
        const cairo_path_data_t *data = &path->data[index];
        if (data->header.type == CAIRO_PATH_MOVE_TO) {
            first[0] = last[0] = data[1].point.x;
            first[1] = last[1] = data[1].point.y;
        } else if (data->header.type == CAIRO_PATH_LINE_TO) {
            area += 0.5 * (last[0] * data[1].point.y - data[1].point.x * last[1]);
            last[0] = data[1].point.x;
            last[1] = data[1].point.y;
        } else {
            area += 0.5 * (last[0] * first[1] - first[0] * last[1]);
        }
    }
    cairo_path_destroy(path);
    cairo_new_path(context);
    return fabs(area);
}

static json_t *grid_specification(int columns, int rows, bool scattered)
{
    json_t *list = json_array();
    for (int row = 0; row < rows; row++) {
        for (int column = 0; column < columns; column++) {
            /* An affine map, so that no two values agree and there is no grid. */
            const double x = column + (scattered ? 0.013 * row : 0.0);
            const double y = row + (scattered ? 0.017 * column : 0.0);
            (void)json_array_append_new(list, json_pack("{s:{s:f, s:f}, s:s, s:{s:f}}",
                                                        "parameters", "x", x, "y", y, "state",
                                                        "succeeded", "metrics", "m", 2.0 * x + y));
        }
    }
    return json_pack("{s:o, s:{s:s, s:s, s:s}}", "rows", list, "chart", "x", "x", "y", "y", "z",
                     "m");
}

/* Of a plane over a unit square of shares, the part above a level is known: it is 1 - t^2 / 4 for
 * 2 x + y = t up to 1, with x and y as shares; both meshes reproduce a plane without error. */
static void test_mesh_of_a_plane(void **state)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 8, 8);
    cairo_t *context = cairo_create(surface);
    (void)state;
    for (int scattered = 0; scattered <= 1; scattered++) {
        struct talus_error error = {0};
        struct chart_mesh mesh;
        json_t *specification = grid_specification(5, 5, scattered != 0);
        struct chart *chart = chart_create(specification, &error);
        assert_non_null(chart);
        assert_int_equal(chart->gridded, scattered == 0);
        struct chart_frame frame = {
            .plot = {0, 0, 1000, 1000}, .x_scale = {false, 0.0, 4.0}, .y_scale = {false, 0.0, 4.0}};
        assert_true(chart_mesh_init(&mesh, chart, 0, &frame));
        chart_mesh_above(&mesh, &frame, -INFINITY, INFINITY, context);
        const double whole = path_area(context);
        /* The affine map of the scattered points changes areas by its determinant. */
        assert_true(fabs(whole - 1e6 * (scattered == 0 ? 1.0 : 1.0 - 0.013 * 0.017)) < 100.0);
        if (scattered == 0) {
            chart_mesh_above(&mesh, &frame, 3.0, INFINITY, context);
            assert_true(fabs(path_area(context) - 1e6 * (1.0 - 0.75 * 0.75 / 4.0)) < 50.0);
        }
        chart_mesh_above(&mesh, &frame, 100.0, INFINITY, context);
        assert_true(path_area(context) < 1e-9);
        chart_mesh_above(&mesh, &frame, 0.0, 0.0, context); /* all of it is covered */
        assert_true(path_area(context) < 1e-9);
        chart_mesh_release(&mesh);
        chart_destroy(chart);
        json_decref(specification);
    }
    cairo_destroy(context);
    cairo_surface_destroy(surface);
}

/* A missing node leaves the triangle of the other three of each of its four cells. */
static void test_mesh_with_a_hole(void **state)
{
    struct talus_error error = {0};
    struct chart_mesh mesh;
    json_t *specification = grid_specification(5, 5, false);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 8, 8);
    cairo_t *context = cairo_create(surface);
    (void)state;
    json_t *row = json_array_get(json_object_get(specification, "rows"), 12);
    (void)json_object_set_new(json_object_get(row, "metrics"), "m", json_null());
    struct chart *chart = chart_create(specification, &error);
    assert_non_null(chart);
    assert_int_equal(chart->missing, 1);
    struct chart_frame frame = {
        .plot = {0, 0, 1000, 1000}, .x_scale = {false, 0.0, 4.0}, .y_scale = {false, 0.0, 4.0}};
    assert_true(chart_mesh_init(&mesh, chart, 0, &frame));
    chart_mesh_above(&mesh, &frame, -INFINITY, INFINITY, context);
    assert_true(fabs(path_area(context) - 1e6 * (14.0 / 16.0)) < 50.0);
    chart_mesh_release(&mesh);
    chart_destroy(chart);
    json_decref(specification);
    cairo_destroy(context);
    cairo_surface_destroy(surface);
}

static void test_front(void **state)
{
    struct chart_point points[] = {{.x = 4, .y = 1}, {.x = 1, .y = 4}, {.x = 2, .y = 5},
                                   {.x = 3, .y = 2}, {.x = 3, .y = 3}, {.x = 5, .y = 1},
                                   {.x = 1, .y = 4}};
    (void)state;
    assert_int_equal(chart_front(points, 7), 3);
    assert_true(points[0].x == 1 && points[0].y == 4);
    assert_true(points[1].x == 3 && points[1].y == 2);
    assert_true(points[2].x == 4 && points[2].y == 1);
    assert_int_equal(chart_front(points, 0), 0);
}

/* Neighbours in a legend differ in more than colour, and the colours of words are apart. */
static void test_styles(void **state)
{
    (void)state;
    for (size_t index = 1; index < 7; index++) {
        const struct chart_style one = chart_style_find(index - 1, 7, false);
        const struct chart_style other = chart_style_find(index, 7, false);
        assert_true(one.marker != other.marker);
        assert_true(fabs(one.colour.red - other.colour.red) +
                        fabs(one.colour.green - other.colour.green) +
                        fabs(one.colour.blue - other.colour.blue) >
                    0.3);
    }
    assert_int_not_equal(chart_style_find(0, 9, false).dashes,
                         chart_style_find(7, 9, false).dashes);
    assert_true(chart_style_find(0, 5, true).colour.green <
                chart_style_find(4, 5, true).colour.green);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ticks),           cmocka_unit_test(test_scales),
        cmocka_unit_test(test_triangles),       cmocka_unit_test(test_triangles_of_a_line),
        cmocka_unit_test(test_mesh_of_a_plane), cmocka_unit_test(test_mesh_with_a_hole),
        cmocka_unit_test(test_front),           cmocka_unit_test(test_styles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

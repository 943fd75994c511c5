/* SPDX-License-Identifier: Apache-2.0 */
/* The parts of a picture that can be judged by numbers. */
#include "output/render_colour.h"
#include "output/render_field.h"
#include "output/render_raster.h"
#include "output/render_view.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void test_range_keeps_all_of_an_even_spread(void **state)
{
    (void)state;
    struct talus_error error = {0};
    struct colour_range range;
    double values[1000];
    for (int index = 0; index < 1000; index++)
        values[index] = index;
    assert_int_equal(colour_range_find(values, 1000, &range, &error), TALUS_OK);
    assert_true(range.low == 0.0 && range.high == 999.0);
    assert_true(range.minimum == 0.0 && range.maximum == 999.0);
    assert_true(isnan(colour_range_position(&range, NAN)));
    assert_true(colour_range_position(&range, -5.0) == 0.0);
    assert_true(colour_range_position(&range, 2000.0) == 1.0);
}

static void test_range_cuts_a_few_far_values(void **state)
{
    (void)state;
    struct talus_error error = {0};
    struct colour_range range;
    double values[1000];
    for (int index = 0; index < 1000; index++)
        values[index] = index;
    values[17] = 1e6;
    values[18] = NAN;
    values[19] = INFINITY;
    assert_int_equal(colour_range_find(values, 1000, &range, &error), TALUS_OK);
    assert_true(range.high < 1000.0 && range.maximum == 1e6 && range.low == 0.0);
}

static void test_range_of_few_different_values(void **state)
{
    (void)state;
    struct talus_error error = {0};
    struct colour_range range;
    double values[500] = {0.0};
    assert_int_equal(colour_range_find(values, 500, &range, &error), TALUS_OK);
    assert_true(range.low < 0.0 && range.high > 0.0 && range.minimum == range.maximum);
    values[250] = 3.0; /* one yielding particle is what there is to see */
    assert_int_equal(colour_range_find(values, 500, &range, &error), TALUS_OK);
    assert_true(range.low == 0.0 && range.high == 3.0);
    assert_int_equal(colour_range_find(values, 0, &range, &error), TALUS_OK);
    assert_true(range.low < range.high);
}

static void test_ticks(void **state)
{
    (void)state;
    char text[32];
    struct ticks ticks = ticks_find(0.0, 0.3, 6);
    assert_true(fabs(ticks.step - 0.05) < 1e-15);
    assert_true(ticks.first == 0 && ticks.last == 6);
    ticks_format(&ticks, 3, text, sizeof text);
    assert_string_equal(text, "0.15");
    ticks = ticks_find(-2.3e6, 1.1e6, 5);
    assert_true(ticks.step == 5e5 && ticks.first == -4 && ticks.last == 2);
    ticks_format(&ticks, -3, text, sizeof text);
    assert_string_equal(text, "-1.5e+06");
}

/* Ends and middle of the published table of viridis. */
static void test_colour_map(void **state)
{
    (void)state;
    const struct {
        double position, red, green, blue;
    } table[] = {
        {0.0, 0.267, 0.005, 0.329}, {0.5, 0.128, 0.567, 0.551}, {1.0, 0.993, 0.906, 0.144}};
    for (size_t index = 0; index < 3; index++) {
        const struct colour colour = colour_from_map(table[index].position);
        assert_true(fabs(colour.red - table[index].red) < 0.02);
        assert_true(fabs(colour.green - table[index].green) < 0.02);
        assert_true(fabs(colour.blue - table[index].blue) < 0.02);
    }
    assert_true(colour_from_map(NAN).red == colour_from_map(NAN).blue);
}

static uint32_t pixel_at(const struct raster *raster, int x, int y)
{
    return raster->pixels[y * raster->width + x];
}

static void test_nearer_hides_farther(void **state)
{
    (void)state;
    struct raster raster;
    assert_true(raster_init(&raster, 40, 30));
    const struct colour red = {1.0, 0.0, 0.0}, blue = {0.0, 0.0, 1.0};
    raster_draw_disc(&raster, (struct screen_point){10.0, 10.0, 5.0}, 6.0, red, false);
    raster_draw_disc(&raster, (struct screen_point){13.0, 10.0, 9.0}, 6.0, blue, false);
    assert_int_equal(pixel_at(&raster, 9, 9), 0xff0000);
    assert_int_equal(pixel_at(&raster, 13, 9), 0xff0000); /* in both: the first is nearer */
    assert_int_equal(pixel_at(&raster, 17, 9), 0x0000ff);
    assert_int_equal(pixel_at(&raster, 25, 9), 0xffffff);
    const struct screen_point corners[4] = {
        {5.0, 5.0, 0.0}, {15.0, 5.0, 0.0}, {15.0, 15.0, 20.0}, {5.0, 15.0, 20.0}};
    raster_draw_quad(&raster, corners, blue); /* tilted: its top is in front of the disc */
    assert_int_equal(pixel_at(&raster, 10, 5), 0x0000ff);
    assert_int_equal(pixel_at(&raster, 10, 12), 0xff0000);
    /* Far outside, without extent, or not a number: nothing happens, nothing is overrun. */
    raster_draw_disc(&raster, (struct screen_point){1e300, -1e300, 0.0}, 1e200, red, true);
    raster_draw_disc(&raster, (struct screen_point){NAN, 1.0, 0.0}, 3.0, red, true);
    raster_draw_line(&raster, corners[0], corners[0], 2.0, red);
    raster_release(&raster);
}

static void test_field_reductions(void **state)
{
    (void)state;
    struct talus_error error = {0};
    double velocity[6] = {3.0, 0.0, 4.0, 0.0, -2.0, 0.0};
    assert_int_equal(render_field_reduce(velocity, 2, 3, "", &error), TALUS_OK);
    assert_true(velocity[0] == 5.0 && velocity[1] == 2.0);
    double uniaxial[6] = {-7.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    assert_int_equal(render_field_reduce(uniaxial, 1, 6, "", &error), TALUS_OK);
    assert_true(fabs(uniaxial[0] - 7.0) < 1e-14);
    double shear[6] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
    assert_int_equal(render_field_reduce(shear, 1, 6, "xz", &error), TALUS_OK);
    assert_true(shear[0] == 6.0);
    double gradient[9] = {2.0, 1.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.5};
    assert_int_equal(render_field_reduce(gradient, 1, 9, "det", &error), TALUS_OK);
    assert_true(gradient[0] == 3.0);
    assert_int_equal(render_field_reduce(velocity, 1, 3, "xx", &error), TALUS_INVALID);
    assert_string_equal(error.pointer, "/field");
}

/* A point keeps its distances: the view is orthographic, with up against gravity. */
static void test_view(void **state)
{
    (void)state;
    struct render_scene scene = {.axis_count = 3, .up_axis = 2, .up_sign = 1.0, .spacing = 0.1};
    const double positions[6] = {0.05, 0.05, 0.05, 7.95, 3.95, 1.95};
    for (int axis = 0; axis < 3; axis++) {
        scene.cell[axis] = 0.2;
        scene.grid_max[axis] = 100.0;
    }
    const struct box3 box = view_find_box(&scene, positions, 2, NULL, 0);
    for (int axis = 0; axis < 3; axis++)
        assert_true(box.min[axis] <= positions[axis] && box.max[axis] >= positions[3 + axis]);
    assert_true(box.max[0] < 10.0);
    struct view view;
    view_init(&view, &scene, box);
    view_fit(&view, (struct rectangle){10.0, 20.0, 300.0, 200.0});
    const double low[3] = {1.0, 1.0, 0.0}, high[3] = {1.0, 1.0, 2.0};
    const struct screen_point bottom = view_project(&view, low), top = view_project(&view, high);
    assert_true(fabs(top.x - bottom.x) < 1e-9 && top.y < bottom.y);
    assert_true(top.depth < bottom.depth); /* seen from above */
    for (int corner = 0; corner < 8; corner++) {
        double position[3];
        for (int axis = 0; axis < 3; axis++)
            position[axis] = (corner >> axis & 1) != 0 ? box.max[axis] : box.min[axis];
        const struct screen_point point = view_project(&view, position);
        assert_true(point.x > 10.0 - 1e-9 && point.x < 310.0 + 1e-9);
        assert_true(point.y > 20.0 - 1e-9 && point.y < 220.0 + 1e-9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_range_keeps_all_of_an_even_spread),
        cmocka_unit_test(test_range_cuts_a_few_far_values),
        cmocka_unit_test(test_range_of_few_different_values),
        cmocka_unit_test(test_ticks),
        cmocka_unit_test(test_colour_map),
        cmocka_unit_test(test_nearer_hides_farther),
        cmocka_unit_test(test_field_reductions),
        cmocka_unit_test(test_view),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

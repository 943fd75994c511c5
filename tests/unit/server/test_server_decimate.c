/* SPDX-License-Identifier: Apache-2.0 */
#include "decimate.h"
#include "server_fixture.h"

#include <math.h>

enum { COUNT = 1000 };

static void curve_fill(double *time, double *value)
{
    for (size_t index = 0; index < COUNT; index++) {
        time[index] = (double)index;
        value[index] = sin(0.01 * (double)index);
    }
}

static void test_short_curves_stay(void **state)
{
    double time[3] = {0, 1, 2}, value[3] = {5, 6, 7};
    (void)state;
    assert_int_equal(decimate(time, value, 3, 4), 3);
    assert_true(value[1] == 6);
}

static void test_peaks_and_ends_stay(void **state)
{
    double time[COUNT], value[COUNT];
    (void)state;
    for (size_t max_points = 4; max_points < COUNT; max_points += 7) {
        curve_fill(time, value);
        value[333] = 1e6;
        value[777] = -1e6;
        size_t count = decimate(time, value, COUNT, max_points);
        assert_true(count <= max_points && count >= 3);
        assert_true(time[0] == 0 && time[count - 1] == COUNT - 1);
        bool highest = false, lowest = false;
        for (size_t index = 0; index < count; index++) {
            highest = highest || (time[index] == 333 && value[index] == 1e6);
            lowest = lowest || (time[index] == 777 && value[index] == -1e6);
            assert_true(index == 0 || time[index] > time[index - 1]);
        }
        assert_true(highest && lowest);
    }
}

static void test_kept_points_are_points_of_the_curve(void **state)
{
    double time[COUNT], value[COUNT];
    (void)state;
    curve_fill(time, value);
    size_t count = decimate(time, value, COUNT, 50);
    for (size_t index = 0; index < count; index++)
        assert_true(value[index] == sin(0.01 * time[index]));
}

static void test_not_a_number_is_no_peak(void **state)
{
    double time[COUNT], value[COUNT];
    (void)state;
    curve_fill(time, value);
    for (size_t index = 400; index < 450; index += 2)
        value[index] = NAN;
    value[425] = 9;
    size_t count = decimate(time, value, COUNT, 20), found = 0;
    for (size_t index = 0; index < count; index++)
        found += value[index] == 9;
    assert_int_equal(found, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_short_curves_stay),
        cmocka_unit_test(test_peaks_and_ends_stay),
        cmocka_unit_test(test_kept_points_are_points_of_the_curve),
        cmocka_unit_test(test_not_a_number_is_no_peak),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation_fixture.h"
#include "state/time_table.h"

static double times[] = {1.0, 2.0, 4.0};
static double values[] = {10.0, -10.0, 30.0};
static const struct talus_time_table table = {.count = 3, .time = times, .value = values};

static void test_linear_between_and_constant_outside(void **state)
{
    (void)state;
    static const double expected[][2] = {{-5.0, 10.0}, {1.0, 10.0}, {1.25, 5.0}, {2.0, -10.0},
                                         {3.0, 10.0},  {3.5, 20.0}, {4.0, 30.0}, {1e9, 30.0}};
    for (size_t index = 0; index < sizeof expected / sizeof expected[0]; index++)
        assert_float_equal(time_table_value(&table, 7.0, expected[index][0]), expected[index][1],
                           1e-14);
}

static void test_without_points_the_number_holds(void **state)
{
    (void)state;
    const struct talus_time_table tables[3] = {{0}, table, {0}};
    const double constant[3] = {7.0, 8.0, 9.0};
    double value[3];
    time_table_vector(tables, constant, 2.0, value);
    assert_float_equal(value[0], 7.0, 0.0);
    assert_float_equal(value[1], -10.0, 0.0);
    assert_float_equal(value[2], 9.0, 0.0);
    assert_true(time_table_varies(tables, 3));
    assert_false(time_table_varies(tables, 1));
}

static void test_a_copy_owns_its_arrays(void **state)
{
    (void)state;
    struct talus_time_table copy[2] = {table, {0}};
    assert_int_equal(time_table_duplicate(copy, 2), 0);
    assert_ptr_not_equal(copy[0].time, times);
    assert_float_equal(time_table_value(&copy[0], 0.0, 3.5), 20.0, 1e-14);
    time_table_release(copy, 2);
    assert_null(copy[0].time);
    assert_int_equal(copy[0].count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_between_and_constant_outside),
        cmocka_unit_test(test_without_points_the_number_holds),
        cmocka_unit_test(test_a_copy_owns_its_arrays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

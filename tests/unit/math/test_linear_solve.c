/* SPDX-License-Identifier: Apache-2.0 */
#include "math/linear_solve.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/* A matrix that needs pivoting (zeros on the diagonal) in every size, times a known vector. */
static void test_known_solutions(void **context)
{
    (void)context;
    for (size_t size = 1; size <= LINEAR_SOLVE_MAX; size++) {
        double matrix[LINEAR_SOLVE_MAX][LINEAR_SOLVE_MAX];
        double right[LINEAR_SOLVE_MAX] = {0};
        for (size_t row = 0; row < size; row++) {
            for (size_t column = 0; column < size; column++) {
                double value = sin(3.0 * (double)(row * row) + 5.0 * (double)column + 1.0);
                matrix[row][column] = row == column && size > 1 ? 0.0 : value;
                right[row] += matrix[row][column] * ((double)column - 1.5);
            }
        }
        assert_true(linear_solve(size, matrix, right));
        for (size_t row = 0; row < size; row++)
            assert_true(fabs(right[row] - ((double)row - 1.5)) < 1e-11);
    }
}

static void test_singular(void **context)
{
    (void)context;
    double zero[LINEAR_SOLVE_MAX][LINEAR_SOLVE_MAX] = {{0}};
    double dependent[LINEAR_SOLVE_MAX][LINEAR_SOLVE_MAX] = {{1, 2}, {0.1, 0.2}};
    double not_a_number[LINEAR_SOLVE_MAX][LINEAR_SOLVE_MAX] = {{NAN, 1}, {1, 1}};
    double right[LINEAR_SOLVE_MAX] = {1, 1};
    assert_false(linear_solve(2, zero, right));
    assert_false(linear_solve(2, dependent, right));
    assert_false(linear_solve(2, not_a_number, right));
    assert_true(linear_solve(0, zero, right)); /* nothing to solve */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_solutions),
        cmocka_unit_test(test_singular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "math/linear_solve.h"

#include <math.h>

static size_t find_pivot(size_t size, double matrix[][LINEAR_SOLVE_MAX], size_t column)
{
    size_t pivot = column;
    for (size_t row = column + 1; row < size; row++) {
        if (fabs(matrix[row][column]) > fabs(matrix[pivot][column]))
            pivot = row;
    }
    return pivot;
}

static void swap(double *a, double *b)
{
    double kept = *a;
    *a = *b;
    *b = kept;
}

bool linear_solve(size_t size, double matrix[LINEAR_SOLVE_MAX][LINEAR_SOLVE_MAX], double *right)
{
    double largest = 0.0;
    for (size_t row = 0; row < size; row++) {
        for (size_t column = 0; column < size; column++)
            largest = fmax(largest, fabs(matrix[row][column]));
    }
    for (size_t column = 0; column < size; column++) {
        size_t pivot = find_pivot(size, matrix, column);
        /* not "<=": NAN must fail too */
        if (!(fabs(matrix[pivot][column]) > 1e-13 * largest))
            return false;
        swap(&right[pivot], &right[column]);
        for (size_t entry = column; entry < size; entry++)
            swap(&matrix[pivot][entry], &matrix[column][entry]);
        for (size_t row = column + 1; row < size; row++) {
            double factor = matrix[row][column] / matrix[column][column];
            for (size_t entry = column; entry < size; entry++)
                matrix[row][entry] -= factor * matrix[column][entry];
            right[row] -= factor * right[column];
        }
    }
    for (size_t row = size; row-- > 0;) {
        for (size_t column = row + 1; column < size; column++)
            right[row] -= matrix[row][column] * right[column];
        right[row] /= matrix[row][row];
    }
    return true;
}

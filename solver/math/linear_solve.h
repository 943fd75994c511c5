/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_LINEAR_SOLVE_H
#define TALUS_LINEAR_SOLVE_H

#include <stdbool.h>
#include <stddef.h>

enum { LINEAR_SOLVE_MAX = 6 };

/* Solves matrix x = right in place (right becomes x, the matrix is used up) by elimination with
 * partial pivoting; size is at most LINEAR_SOLVE_MAX. False if the matrix is singular to working
 * precision: the contents are then undefined. */
bool linear_solve(size_t size, double matrix[LINEAR_SOLVE_MAX][LINEAR_SOLVE_MAX], double *right);

#endif

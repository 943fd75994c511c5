/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_EIGEN_H
#define TALUS_EIGEN_H

#include "math/tensor.h"

/* Eigenvalues (unordered) and orthonormal eigenvectors (columns of *vectors) of a symmetric matrix
 * by cyclic Jacobi rotations: repeated eigenvalues are no special case, and small eigenvalues of a
 * graded matrix keep their digits. A matrix that holds NaN gives NaN. */
void sym3_eigen(struct sym3 matrix, real values[3], struct mat3 *vectors);

/* Sum of values[i] n_i (x) n_i over the columns n_i of *vectors. */
struct sym3 sym3_from_eigen(const real values[3], const struct mat3 *vectors);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
#include "math/eigen.h"

/* Turns rows and columns p and q of `a` so that a[p][q] vanishes (Golub and Van Loan, sec. 8.5). */
static void jacobi_rotate(real a[3][3], struct mat3 *vectors, int p, int q)
{
    if (a[p][q] == 0.0)
        return;
    real theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    real tangent =
        (theta < 0.0 ? -1.0 : 1.0) / (real_absolute(theta) + real_sqrt(1.0 + theta * theta));
    real cosine = 1.0 / real_sqrt(1.0 + tangent * tangent);
    real sine = tangent * cosine;
    int other = 3 - p - q;

    a[p][p] -= tangent * a[p][q];
    a[q][q] += tangent * a[p][q];
    a[p][q] = a[q][p] = 0.0;
    real op = a[other][p];
    real oq = a[other][q];
    a[other][p] = a[p][other] = cosine * op - sine * oq;
    a[other][q] = a[q][other] = sine * op + cosine * oq;
    for (int row = 0; row < 3; row++) {
        real vp = vectors->m[row][p];
        real vq = vectors->m[row][q];
        vectors->m[row][p] = cosine * vp - sine * vq;
        vectors->m[row][q] = sine * vp + cosine * vq;
    }
}

void sym3_eigen(struct sym3 matrix, real values[3], struct mat3 *vectors)
{
    enum { SWEEP_MAX = 12 }; /* quadratic convergence: five are enough in practice */
    struct mat3 full = mat3_from_sym3(matrix);
    real tolerance = 1e-18 * sym3_norm(matrix);

    *vectors = (struct mat3){{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    for (int sweep = 0; sweep < SWEEP_MAX; sweep++) {
        real off =
            real_absolute(full.m[0][1]) + real_absolute(full.m[0][2]) + real_absolute(full.m[1][2]);
        if (off <= tolerance)
            break;
        jacobi_rotate(full.m, vectors, 0, 1);
        jacobi_rotate(full.m, vectors, 0, 2);
        jacobi_rotate(full.m, vectors, 1, 2);
    }
    for (int index = 0; index < 3; index++)
        values[index] = full.m[index][index];
}

struct sym3 sym3_from_eigen(const real values[3], const struct mat3 *vectors)
{
    struct sym3 sum = {0};
    for (int index = 0; index < 3; index++) {
        real x = vectors->m[0][index];
        real y = vectors->m[1][index];
        real z = vectors->m[2][index];
        struct sym3 dyad = {x * x, y * y, z * z, x * y, y * z, x * z};
        sum = sym3_add_scaled(sum, values[index], dyad);
    }
    return sum;
}

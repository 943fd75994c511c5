/* SPDX-License-Identifier: Apache-2.0 */
/* Functions of a symmetric tensor without eigenvectors. Every power of a tensor D without trace
 * reduces to I, D and D^2 by the theorem of Cayley and Hamilton, D^3 = J2 D + J3 I with
 * J2 = tr(D^2)/2 and J3 = det D, so that a function of D is three numbers that depend on J2 and J3
 * only. Everything here inlines into vectorised loops. */
#ifndef TALUS_TENSOR_FUNCTION_H
#define TALUS_TENSOR_FUNCTION_H

#include "math/elementary.h"
#include "math/tensor.h"

/* J2 below which D counts as none, so that nothing here divides by zero or underflows. */
#ifdef TALUS_SINGLE
#define TENSOR_FUNCTION_TINY 1e-18f
#else
#define TENSOR_FUNCTION_TINY 1e-60
#endif

struct invariants {
    real J2, J3;
};

/* c0 I + c1 D + c2 D^2 */
struct combination {
    real c0, c1, c2;
};

/* r D + constant I: one step of Horner's scheme, in two multiplications and additions. */
TALUS_INLINE struct combination combination_step(struct combination r, real constant,
                                                 struct invariants of)
{
    return (struct combination){of.J3 * r.c2 + constant, r.c0 + of.J2 * r.c2, r.c1};
}

/* r D */
TALUS_INLINE struct combination combination_shift(struct combination r, struct invariants of)
{
    return (struct combination){of.J3 * r.c2, r.c0 + of.J2 * r.c2, r.c1};
}

/* A symmetric tensor is mean I + D. */
TALUS_INLINE struct sym3 traceless_part(struct sym3 a, real mean)
{
    return sym3_add_diagonal(a, -mean);
}

/* D^2 - J2 I, which costs less than D^2. */
TALUS_INLINE struct sym3 traceless_cofactor(struct sym3 d)
{
    return (struct sym3){d.yy * d.zz - d.yz * d.yz, d.xx * d.zz - d.xz * d.xz,
                         d.xx * d.yy - d.xy * d.xy, d.xz * d.yz - d.xy * d.zz,
                         d.xy * d.xz - d.xx * d.yz, d.xy * d.yz - d.yy * d.xz};
}

/* Eigenvalues of D: `far` is the one that lies apart; far, middle, last are in falling or in rising
 * order. */
struct eigenvalues {
    real far, middle, last;
};

/* The largest root m of m^3 - 3 m = 2 r, 0 <= r <= 1, by Newton from a cubic that is within 1e-4:
 * it lies apart from the others, which follow from it. Where those two meet they are known to half
 * of the digits only, but their sum and product to all: so is what interpolates between them. */
TALUS_INLINE struct eigenvalues traceless_eigenvalues(struct invariants of)
{
    const real third = of.J2 * (1.0 / 3.0);
    const real size = real_sqrt(third > TENSOR_FUNCTION_TINY ? third : TENSOR_FUNCTION_TINY);
    const real twice = real_absolute(of.J3) / (size * size * size);
    const real r = 0.5 * (twice < 2.0 ? twice : (real)2.0);
    real m = ((0.01863937 * r - 0.08138239) * r + 0.3306607) * r + 1.7321327;
    m -= (m * (m * m - 3.0) - 2.0 * r) / (3.0 * (m * m - 1.0));
    m -= (m * (m * m - 3.0) - 2.0 * r) / (3.0 * (m * m - 1.0));
    const real square = 3.0 - 0.75 * m * m;
    const real half = real_sqrt(square > 0.0 ? square : (real)0.0);
    const real factor = of.J3 < 0.0 ? -size : size;
    return (struct eigenvalues){factor * m, factor * (half - 0.5 * m), factor * (-half - 0.5 * m)};
}

#endif

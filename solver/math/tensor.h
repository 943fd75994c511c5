/* SPDX-License-Identifier: Apache-2.0 */
/* Value structs for small vectors and tensors. Everything is inlined into the loops that use it, so
 * that a loop over a structure of arrays vectorises; symmetric shear components are tensorial. */
#ifndef TALUS_TENSOR_H
#define TALUS_TENSOR_H

#include "base/inline.h"
#include "math/real.h"

struct vec3 {
    real x, y, z;
};

struct sym3 {
    real xx, yy, zz, xy, yz, xz;
};

struct mat3 {
    real m[3][3]; /* m[row][column] */
};

/* Place of component (row, column) of a symmetric tensor in the order xx yy zz xy yz xz. */
static const unsigned char sym3_component[3][3]
    __attribute__((unused)) = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

TALUS_INLINE real vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

TALUS_INLINE real sym3_trace(struct sym3 a)
{
    return a.xx + a.yy + a.zz;
}

/* a : b, every off-diagonal pair counted twice. */
TALUS_INLINE real sym3_dot(struct sym3 a, struct sym3 b)
{
    return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz +
           (real)2.0 * (a.xy * b.xy + a.yz * b.yz + a.xz * b.xz);
}

TALUS_INLINE real sym3_norm(struct sym3 a)
{
    return real_sqrt(sym3_dot(a, a));
}

TALUS_INLINE struct sym3 sym3_add(struct sym3 a, struct sym3 b)
{
    return (struct sym3){a.xx + b.xx, a.yy + b.yy, a.zz + b.zz,
                         a.xy + b.xy, a.yz + b.yz, a.xz + b.xz};
}

TALUS_INLINE struct sym3 sym3_scale(real factor, struct sym3 a)
{
    return (struct sym3){factor * a.xx, factor * a.yy, factor * a.zz,
                         factor * a.xy, factor * a.yz, factor * a.xz};
}

/* a + factor b */
TALUS_INLINE struct sym3 sym3_add_scaled(struct sym3 a, real factor, struct sym3 b)
{
    return sym3_add(a, sym3_scale(factor, b));
}

/* a + value 1 */
TALUS_INLINE struct sym3 sym3_add_diagonal(struct sym3 a, real value)
{
    return (struct sym3){a.xx + value, a.yy + value, a.zz + value, a.xy, a.yz, a.xz};
}

TALUS_INLINE struct sym3 sym3_deviator(struct sym3 a)
{
    return sym3_add_diagonal(a, -sym3_trace(a) * ((real)1.0 / (real)3.0));
}

/* a a */
TALUS_INLINE struct sym3 sym3_square(struct sym3 a)
{
    return (struct sym3){
        a.xx * a.xx + a.xy * a.xy + a.xz * a.xz, a.yy * a.yy + a.xy * a.xy + a.yz * a.yz,
        a.zz * a.zz + a.xz * a.xz + a.yz * a.yz, a.xy * (a.xx + a.yy) + a.xz * a.yz,
        a.yz * (a.yy + a.zz) + a.xy * a.xz,      a.xz * (a.xx + a.zz) + a.xy * a.yz};
}

TALUS_INLINE real sym3_determinant(struct sym3 a)
{
    return a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.xz) +
           a.xz * (a.xy * a.yz - a.yy * a.xz);
}

TALUS_INLINE struct mat3 mat3_multiply(struct mat3 a, struct mat3 b)
{
    struct mat3 c;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    }
    return c;
}

TALUS_INLINE real mat3_determinant(struct mat3 a)
{
    return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) -
           a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
           a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}

TALUS_INLINE struct mat3 mat3_from_sym3(struct sym3 a)
{
    return (struct mat3){{{a.xx, a.xy, a.xz}, {a.xy, a.yy, a.yz}, {a.xz, a.yz, a.zz}}};
}

/* Symmetric part. */
TALUS_INLINE struct sym3 mat3_symmetric(struct mat3 a)
{
    return (struct sym3){a.m[0][0],
                         a.m[1][1],
                         a.m[2][2],
                         (real)0.5 * (a.m[0][1] + a.m[1][0]),
                         (real)0.5 * (a.m[1][2] + a.m[2][1]),
                         (real)0.5 * (a.m[0][2] + a.m[2][0])};
}

/* Component (i, j) of a b^T. */
TALUS_INLINE real mat3_row_product(struct mat3 a, int i, struct mat3 b, int j)
{
    return a.m[i][0] * b.m[j][0] + a.m[i][1] * b.m[j][1] + a.m[i][2] * b.m[j][2];
}

/* r a r^T for a symmetric a: turns it by the rotation r, or pushes it forward by r. */
TALUS_INLINE struct sym3 sym3_push_forward(struct mat3 r, struct sym3 a)
{
    struct mat3 half = mat3_multiply(r, mat3_from_sym3(a));
    return (struct sym3){mat3_row_product(half, 0, r, 0), mat3_row_product(half, 1, r, 1),
                         mat3_row_product(half, 2, r, 2), mat3_row_product(half, 0, r, 1),
                         mat3_row_product(half, 1, r, 2), mat3_row_product(half, 0, r, 2)};
}

#endif

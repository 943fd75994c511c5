/* SPDX-License-Identifier: Apache-2.0 */
/* Principal values and axes of symmetric tensors, inlined into vectorised loops; repeated values
 * are no special case. Of the three values of a tensor one lies apart from the others, at least
 * sqrt(3) times the size sqrt(J2/3) from them; its axis is well determined whatever the others do.
 * What is left across that axis is a tensor in a plane, which one rotation makes diagonal. Every
 * value is then n . A n of its axis, which errs by the square of the axis's error only. */
#ifndef TALUS_PRINCIPAL_AXES_H
#define TALUS_PRINCIPAL_AXES_H

#include "math/tensor_function.h"

/* What keeps a division by nothing finite. */
#ifdef TALUS_SINGLE
#define PRINCIPAL_AXES_LEAST 1e-30f
#else
#define PRINCIPAL_AXES_LEAST 1e-280
#endif

TALUS_INLINE struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

TALUS_INLINE struct vec3 vec3_combine(real p, struct vec3 a, real q, struct vec3 b)
{
    return (struct vec3){p * a.x + q * b.x, p * a.y + q * b.y, p * a.z + q * b.z};
}

/* In numbers: as a choice of each component gcc leaves the loop scalar. */
TALUS_INLINE struct vec3 vec3_longer(struct vec3 a, struct vec3 b)
{
    const real share = vec3_dot(a, a) < vec3_dot(b, b) ? (real)0 : (real)1;
    return vec3_combine(share, a, 1 - share, b);
}

TALUS_INLINE struct vec3 sym3_apply(struct sym3 a, struct vec3 v)
{
    return (struct vec3){a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
                         a.xz * v.x + a.yz * v.y + a.zz * v.z};
}

struct principal_axis { /* a principal value and its axis */
    real value;
    struct vec3 along;
};

struct principal_plane { /* tensor components in a plane with axes u and w */
    struct vec3 u, w;
    real uu, uw, ww;
    real tangent, cosine; /* of the rotation to its principal axes (Jacobi) */
};

TALUS_INLINE struct principal_plane principal_plane_of(struct sym3 d, struct vec3 u, struct vec3 w)
{
    const struct vec3 along_u = sym3_apply(d, u);
    const real uu = vec3_dot(u, along_u);
    const real uw = vec3_dot(w, along_u);
    const real ww = vec3_dot(w, sym3_apply(d, w));
    const real half = (real)0.5 * (ww - uu);
    const real radius = real_sqrt(half * half + uw * uw);
    const real side = half < 0 ? -uw : uw;
    const real length = real_absolute(half) + radius;
    const real tangent = side / (length > PRINCIPAL_AXES_LEAST ? length : PRINCIPAL_AXES_LEAST);
    return (struct principal_plane){
        u, w, uu, uw, ww, tangent, 1 / real_sqrt(1 + tangent * tangent)};
}

TALUS_INLINE struct principal_axis principal_plane_first(struct principal_plane plane)
{
    return (struct principal_axis){
        plane.uu - plane.tangent * plane.uw,
        vec3_combine(plane.cosine, plane.u, -plane.tangent * plane.cosine, plane.w)};
}

TALUS_INLINE struct principal_axis principal_plane_second(struct principal_plane plane)
{
    return (struct principal_axis){
        plane.ww + plane.tangent * plane.uw,
        vec3_combine(plane.tangent * plane.cosine, plane.u, plane.cosine, plane.w)};
}

/* The axis of the value that lies apart, of a tensor d without trace and of size 1: the longest
 * column of the adjoint of d - value. */
TALUS_INLINE struct principal_axis principal_apart(struct sym3 d)
{
    const real J2 = (real)0.5 * sym3_dot(d, d);
    const real far = traceless_eigenvalues((struct invariants){J2, sym3_determinant(d)}).far;
    const struct vec3 x = {d.xx - far, d.xy, d.xz};
    const struct vec3 y = {d.xy, d.yy - far, d.yz};
    const struct vec3 z = {d.xz, d.yz, d.zz - far};
    const struct vec3 column =
        vec3_longer(vec3_longer(vec3_cross(x, y), vec3_cross(y, z)), vec3_cross(z, x));
    const real scale = 1 / real_sqrt(vec3_dot(column, column));
    const struct vec3 n = {scale * column.x, scale * column.y, scale * column.z};
    return (struct principal_axis){vec3_dot(n, sym3_apply(d, n)), n};
}

/* What is left across n: two axes without a branch (Duff et al. 2017), and d in their plane. */
TALUS_INLINE struct principal_plane principal_across(struct sym3 d, struct vec3 n)
{
    const real sign = n.z < 0 ? (real)-1 : (real)1;
    const real a = -1 / (sign + n.z);
    const real b = n.x * n.y * a;
    return principal_plane_of(d, (struct vec3){1 + sign * n.x * n.x * a, sign * b, -sign * n.x},
                              (struct vec3){b, sign + n.y * n.y * a, -n.y});
}

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* The surface of Matsuoka and Nakai along one direction of the deviator (Mast 2013, sec. 3.7).
 *
 * With sb = sigma - c 1 and kappa = 9 + 8 tan^2 phi, F = 6 (kappa det sb - I1b I2b); in terms of
 * P = -tr(sb)/3 > 0, r = |s| and t = det(s)/r^3
 *
 *   F / (6 P^3) = kappa t u^3 + (kappa - 3)/2 u^2 - (kappa - 9),      u = r/P.
 *
 * F < 0 also holds where two principal stresses are tensile. At the border of the octant where all
 * are compressive one of them vanishes and F = -6 I1b I2b > 0; the admissible set is therefore u
 * between 0 and the smallest positive root u*, and that root is unique in the octant. For a given
 * t it is a straight cone |s| = (u* / 3) (3 c - I1): flow that keeps the direction of s has a
 * return in closed form. With u = sqrt(kappa - 9)/w the root is the largest one of
 *
 *   w^3 - (kappa - 3)/2 w - kappa sqrt(kappa - 9) t = 0                        (derived here)
 *
 * which all of kappa >= 9 shares without a special case (kappa = 9: u* = 0). */
#ifndef TALUS_MATSUOKA_NAKAI_SURFACE_H
#define TALUS_MATSUOKA_NAKAI_SURFACE_H

#include "materials/material_kernel.h"

/* (cos(2/3 acos(h)) - 1/2) / h for 0 <= h <= 1 within 6e-9 of itself: interpolated at Chebyshev's
 * nodes. */
TALUS_INLINE real root_polynomial(real h)
{
    const real c0 = (real)0.5773502661742581;
    const real c1 = (real)-0.1111106201233669;
    const real c2 = (real)0.05344492503753065;
    const real c3 = (real)-0.03277693653966827;
    const real c4 = (real)0.02206028030351269;
    const real c5 = (real)-0.01441198482897398;
    const real c6 = (real)0.0077827227005653;
    const real c7 = (real)-0.002827966994270052;
    const real c8 = (real)0.0004893159269461952;
    return c0 + h * (c1 + h * (c2 + h * (c3 + h * (c4 + h * (c5 + h * (c6 + h * (c7 + h * c8)))))));
}

/* With a = sqrt((kappa - 3)/6) the root is w = 2 a z, where 4 z^3 - 3 z = q and
 * q = kappa sqrt(kappa - 9) t / (2 a^3) lies in -1 ... 1: z = cos(acos(q)/3) = 1/2 + h P(h) with
 * h = sqrt((1 + q)/2). The polynomial for P is followed by one step of Newton's method, written for
 * 1/z and freed of 0/0 at h = 0, where two roots meet (friction angles towards 90 degrees). */
struct matsuoka_nakai_root {
    real half; /* h */
    real size; /* sqrt(kappa - 9) / a */
};

TALUS_INLINE struct matsuoka_nakai_root matsuoka_nakai_start(real tangent, real norm,
                                                             real determinant)
{
    const real q_factor = (real)20.784609690826528;    /* 6 sqrt(6) sqrt(2) */
    const real slope_factor = (real)6.928203230275509; /* 2 sqrt(2) sqrt(6) */
    real square = tangent * tangent;
    norm = norm > 0 ? norm : 1;
    real inverse = 1 / (norm * real_sqrt(6 + 8 * square)); /* 1 / (sqrt(6) a |s|) */
    real third = determinant * inverse * inverse * inverse;
    real q = q_factor * tangent * (9 + 8 * square) * third;
    /* the bounds hold round-off of tiny stresses off */
    real half = real_sqrt(maximum(minimum((real)0.5 + (real)0.5 * q, 1), 0));
    return (struct matsuoka_nakai_root){half, slope_factor * tangent * norm * inverse};
}

/* |s| / (3 c - I1) on the surface. */
TALUS_INLINE real matsuoka_nakai_slope(struct matsuoka_nakai_root root)
{
    real h = root.half;
    real p = root_polynomial(h);
    real d = h * p;                                              /* z - 1/2 */
    real newton = p * (1 + d) / (h + p * (3 + d * (6 + 4 * d))); /* 1 / (6 z) */
    return root.size * newton;
}

#endif

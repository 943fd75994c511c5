/* SPDX-License-Identifier: Apache-2.0 */
/* log(1 + x) and exp(x) - 1 of arguments that are known to be small, in fewer operations than the
 * functions of elementary.h, and of whole arrays. What is neglected is under a third of the last
 * digit of a double. */
#ifndef TALUS_LOG1P_SERIES_H
#define TALUS_LOG1P_SERIES_H

#include "math/elementary.h"

#include <stddef.h>

/* |x| <= 0.005 */
TALUS_INLINE real log1p_small(real x)
{
    real sum = 1.0 / 7.0;
    sum = sum * x - 1.0 / 6.0;
    sum = sum * x + 1.0 / 5.0;
    sum = sum * x - 1.0 / 4.0;
    sum = sum * x + 1.0 / 3.0;
    sum = sum * x - 1.0 / 2.0;
    return x + x * (x * sum);
}

/* (atanh(y)/y - 1)/y^2 of z = y^2 <= 0.0085: the polynomial that meets it in Chebyshev's points. */
TALUS_INLINE real atanh_tail(real z)
{
    real sum = 0.078647260763403323;
    sum = sum * z + 0.09089252818337594;
    sum = sum * z + 0.11111118426558889;
    sum = sum * z + 0.14285714271124275;
    sum = sum * z + 0.20000000000010634;
    return sum * z + 1.0 / 3.0;
}

/* -0.16 <= x <= 0.19: 2 atanh(x/(2 + x)) */
TALUS_INLINE real log1p_medium(real x)
{
    const real y = x / (2.0 + x);
    const real z = y * y;
    return x - y * (x - 2.0 * (z * atanh_tail(z)));
}

/* |x| <= EXPM1_SMALL */
#define EXPM1_SMALL ((real)0.003)
TALUS_INLINE real expm1_small(real x)
{
    real sum = 1.0 / 720.0;
    sum = sum * x + 1.0 / 120.0;
    sum = sum * x + 1.0 / 24.0;
    sum = sum * x + 1.0 / 6.0;
    sum = sum * x + 1.0 / 2.0;
    return x + x * (x * sum);
}

/* |x| <= 0.1 */
TALUS_INLINE real expm1_medium(real x)
{
    real sum = 1.0 / 3628800.0;
    sum = sum * x + 1.0 / 362880.0;
    sum = sum * x + 1.0 / 40320.0;
    sum = sum * x + 1.0 / 5040.0;
    sum = sum * x + 1.0 / 720.0;
    sum = sum * x + 1.0 / 120.0;
    sum = sum * x + 1.0 / 24.0;
    sum = sum * x + 1.0 / 6.0;
    sum = sum * x + 1.0 / 2.0;
    return x + x * (x * sum);
}

/* out[i] = log(1 + x[i]); NAN where x <= -1. out may be x. */
void log1p_array(size_t count, const real *x, real *out);

/* out[i] = exp(x[i]) - 1, faster where all of them are small; beyond the range of elementary_exp()
 * the value at its bound. out may be x. */
void expm1_array(size_t count, const real *x, real *out);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Elementary functions that inline into vectorised loops, which the C library's do not: the strain
 * and the friction of every particle need them in every step. No branch, no table. Errors are
 * relative, for double and in its last digits (2^-52) also for single precision. */
#ifndef TALUS_ELEMENTARY_H
#define TALUS_ELEMENTARY_H

#include "math/real.h"
#include "math/tensor.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The parts of a number, and what depends on them. log(2) is the sum of two numbers of which the
 * first has so many zeros at its end that its products with an exponent are exact. */
#ifdef TALUS_SINGLE
typedef uint32_t real_bits;
enum { REAL_MANTISSA_BITS = 23, REAL_EXPONENT_BIAS = 127 };
#define ELEMENTARY_LOG2_HIGH 0x1.62e4p-1f
#define ELEMENTARY_LOG2_LOW 0x1.7f7d1cp-20f
#define ELEMENTARY_WHOLE 0x1p23f
#define ELEMENTARY_EXP_LIMIT 86.0f
#define ELEMENTARY_LOG_LIMIT 0x1p120f
#define ELEMENTARY_HALF_ROOT 0x3f3504f3u
#else
typedef uint64_t real_bits;
enum { REAL_MANTISSA_BITS = 52, REAL_EXPONENT_BIAS = 1023 };
#define ELEMENTARY_LOG2_HIGH 0x1.62e42fee00000p-1
#define ELEMENTARY_LOG2_LOW 0x1.a39ef35793c76p-33
#define ELEMENTARY_WHOLE 0x1p52
#define ELEMENTARY_EXP_LIMIT 700.0
#define ELEMENTARY_LOG_LIMIT 0x1p1000
#define ELEMENTARY_HALF_ROOT 0x3fe6a09e667f3bcdu
#endif

TALUS_INLINE real_bits real_to_bits(real x)
{
    real_bits bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

TALUS_INLINE real real_from_bits(real_bits bits)
{
    real x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* All bits or none. Combined by | and &, which stays straight code where && and ?: of several
 * conditions become branches that no compiler vectorises. */
TALUS_INLINE real_bits real_mask(bool condition)
{
    return condition ? ~(real_bits)0 : (real_bits)0;
}

/* x = power log(2) + rest, |rest| <= log(2)/2. */
struct elementary_split {
    real rest;
    real_bits power; /* in two's complement; only the bits of an exponent are right */
};

TALUS_INLINE struct elementary_split elementary_split(real x)
{
    const real shifter = 1.5 * ELEMENTARY_WHOLE; /* its last bits hold a whole number */
    x = x < -ELEMENTARY_EXP_LIMIT ? -ELEMENTARY_EXP_LIMIT : x;
    x = x > ELEMENTARY_EXP_LIMIT ? ELEMENTARY_EXP_LIMIT : x;
    const real shifted = x * 1.4426950408889634074 + shifter;
    const real whole = shifted - shifter;
    return (struct elementary_split){.rest = (x - whole * ELEMENTARY_LOG2_HIGH) -
                                             whole * ELEMENTARY_LOG2_LOW,
                                     .power = real_to_bits(shifted)};
}

/* (exp(x) - 1 - x)/x^2 for |x| <= log(2)/2, by Taylor. */
TALUS_INLINE real elementary_exp_remainder(real x)
{
    real sum = 1.0 / 6227020800.0; /* 1/13! */
    sum = sum * x + 1.0 / 479001600.0;
    sum = sum * x + 1.0 / 39916800.0;
    sum = sum * x + 1.0 / 3628800.0;
    sum = sum * x + 1.0 / 362880.0;
    sum = sum * x + 1.0 / 40320.0;
    sum = sum * x + 1.0 / 5040.0;
    sum = sum * x + 1.0 / 720.0;
    sum = sum * x + 1.0 / 120.0;
    sum = sum * x + 1.0 / 24.0;
    sum = sum * x + 1.0 / 6.0;
    return sum * x + 0.5;
}

/* exp(x) for -700 <= x <= 700 (86 in single precision); beyond that the value at the bound. */
TALUS_INLINE real elementary_exp(real x)
{
    const struct elementary_split split = elementary_split(x);
    const real r = split.rest;
    const real sum = (elementary_exp_remainder(r) * r + 1.0) * r + 1.0;
    return real_from_bits(real_to_bits(sum) + (split.power << REAL_MANTISSA_BITS));
}

/* exp(x) - 1, in the same range. */
TALUS_INLINE real elementary_expm1(real x)
{
    const struct elementary_split split = elementary_split(x);
    const real r = split.rest;
    const real sum = r + r * (r * elementary_exp_remainder(r));
    const real scale = real_from_bits((split.power + REAL_EXPONENT_BIAS) << REAL_MANTISSA_BITS);
    return scale * sum + (scale - 1.0);
}

/* log(1 + x) for -1 < x < 2^1000 (2^120 in single precision); NAN elsewhere. 1 + x = 2^k (1 + f)
 * with f = x 2^-k + (2^-k - 1): both terms are exact, so f has all its digits, and k = 0 for small
 * x. log(1 + f) as in fdlibm's e_log.c (Sun Microsystems, 1993), which gives the coefficients. */
TALUS_INLINE real elementary_log1p(real x)
{
    const real_bits biased =
        (real_to_bits((real)1.0 + x) - ELEMENTARY_HALF_ROOT + real_to_bits(1.0)) >>
        REAL_MANTISSA_BITS;
    const real scale = real_from_bits((2 * REAL_EXPONENT_BIAS - biased) << REAL_MANTISSA_BITS);
    const real k = real_from_bits(real_to_bits(ELEMENTARY_WHOLE) | biased) -
                   (ELEMENTARY_WHOLE + REAL_EXPONENT_BIAS);
    const real f = x * scale + (scale - 1.0);
    const real y = f / (2.0 + f);
    const real z = y * y;
    real sum = 1.479819860511658591e-01;
    sum = sum * z + 1.531383769920937332e-01;
    sum = sum * z + 1.818357216161805012e-01;
    sum = sum * z + 2.222219843214978396e-01;
    sum = sum * z + 2.857142874366239149e-01;
    sum = sum * z + 3.999999999940941908e-01;
    sum = sum * z + 6.666666666666735130e-01;
    const real half_square = 0.5 * f * f;
    const real rest = half_square - (y * (half_square + sum * z) + k * ELEMENTARY_LOG2_LOW);
    const real value = k * ELEMENTARY_LOG2_HIGH - (rest - f);
    const real_bits outside = real_mask(!(x > -1.0)) | real_mask(!(x < ELEMENTARY_LOG_LIMIT));
    return real_from_bits(real_to_bits(value) | outside); /* all bits set: NAN */
}

/* tan of 0 <= angle < 90 degrees: u R(u^2) / ((1 - u) (1 + u)) with u = angle / 90. The next pole
 * is at u = 3, so that a short polynomial, here interpolated at Chebyshev's nodes, gives R within
 * 3e-17; 90 - angle keeps its digits towards 90 degrees. */
TALUS_INLINE real elementary_tangent_deg(real angle)
{
    const real u = angle * (1.0 / 90.0);
    const real y = u * u;
    real sum = -6.14546131361382e-10;
    sum = sum * y - 2.150997647815949e-09;
    sum = sum * y - 2.739246781374625e-08;
    sum = sum * y - 2.3588610097894262e-07;
    sum = sum * y - 2.135238001309384e-06;
    sum = sum * y - 1.929642096380808e-05;
    sum = sum * y - 1.7588237302397538e-04;
    sum = sum * y - 1.644895127101318e-03;
    sum = sum * y - 1.684617507413467e-02;
    sum = sum * y - 2.788681317823962e-01;
    sum = sum * y + 1.5707963267948966;
    return angle * sum / ((90.0 - angle) * (1.0 + u));
}

#endif

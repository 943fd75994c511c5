/* SPDX-License-Identifier: Apache-2.0 */
/* Elementary functions that inline into vectorised loops, which the C library's do not: the
 * friction of every particle needs them in every step. Within 1e-15 of the exact value. */
#ifndef TALUS_ELEMENTARY_H
#define TALUS_ELEMENTARY_H

#include "math/tensor.h"

#include <stdint.h>
#include <string.h>

/* exp(x) for -700 <= x <= 700; beyond that the value at the bound. */
TALUS_INLINE double elementary_exp(double x)
{
    const double shifter = 6755399441055744.0; /* 1.5 x 2^52: its last bits hold a whole number */
    const double log2_high = 6.93147180369123816490e-01;
    const double log2_low = 1.90821492927058770002e-10;
    x = x < -700.0 ? -700.0 : x;
    x = x > 700.0 ? 700.0 : x;
    double shifted = x * 1.4426950408889634074 + shifter;
    double whole = shifted - shifter;
    double r = (x - whole * log2_high) - whole * log2_low; /* |r| <= log(2)/2 */
    double sum = 1.0 / 6227020800.0;                       /* Taylor: 1/13! ... */
    sum = sum * r + 1.0 / 479001600.0;
    sum = sum * r + 1.0 / 39916800.0;
    sum = sum * r + 1.0 / 3628800.0;
    sum = sum * r + 1.0 / 362880.0;
    sum = sum * r + 1.0 / 40320.0;
    sum = sum * r + 1.0 / 5040.0;
    sum = sum * r + 1.0 / 720.0;
    sum = sum * r + 1.0 / 120.0;
    sum = sum * r + 1.0 / 24.0;
    sum = sum * r + 1.0 / 6.0;
    sum = sum * r + 0.5;
    sum = sum * r + 1.0;
    sum = sum * r + 1.0;
    uint64_t bits;
    uint64_t power;
    memcpy(&bits, &sum, sizeof bits);
    memcpy(&power, &shifted, sizeof power);
    bits += power << 52; /* times 2^whole */
    memcpy(&sum, &bits, sizeof sum);
    return sum;
}

/* sin(x) for 0 <= x <= pi/2. */
TALUS_INLINE double elementary_sine(double x)
{
    double y = x * x;
    double sum = -1.0 / 25852016738884976640000.0; /* Taylor: -1/23! ... */
    sum = sum * y + 1.0 / 51090942171709440000.0;
    sum = sum * y - 1.0 / 121645100408832000.0;
    sum = sum * y + 1.0 / 355687428096000.0;
    sum = sum * y - 1.0 / 1307674368000.0;
    sum = sum * y + 1.0 / 6227020800.0;
    sum = sum * y - 1.0 / 39916800.0;
    sum = sum * y + 1.0 / 362880.0;
    sum = sum * y - 1.0 / 5040.0;
    sum = sum * y + 1.0 / 120.0;
    sum = sum * y - 1.0 / 6.0;
    return x + x * (y * sum);
}

/* tan of 0 <= angle < 90 degrees; the cosine is the sine of the complement, which keeps its digits
 * towards 90 degrees. */
TALUS_INLINE double elementary_tangent_deg(double angle)
{
    const double radians = 3.14159265358979323846 / 180.0;
    return elementary_sine(angle * radians) / elementary_sine((90.0 - angle) * radians);
}

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* log(1 + x) and exp(x) - 1 for small x as polynomials, so that loops over particles vectorise;
 * exact to rounding for |x| <= SERIES_LIMIT, the C library beyond. */
#ifndef TALUS_LOG1P_SERIES_H
#define TALUS_LOG1P_SERIES_H

#include <math.h>
#include <stddef.h>

#define SERIES_LIMIT 0.1

/* ln(1 + x) = 2 atanh(y), y = x / (2 + x). */
static inline double log1p_series(double x)
{
    const double y = x / (2.0 + x), z = y * y;
    double sum = 1.0 / 17.0;
    sum = sum * z + 1.0 / 15.0;
    sum = sum * z + 1.0 / 13.0;
    sum = sum * z + 1.0 / 11.0;
    sum = sum * z + 1.0 / 9.0;
    sum = sum * z + 1.0 / 7.0;
    sum = sum * z + 1.0 / 5.0;
    sum = sum * z + 1.0 / 3.0;
    return 2.0 * (y + y * (z * sum));
}

static inline double expm1_series(double x)
{
    double sum = 1.0 / 479001600.0;
    sum = sum * x + 1.0 / 39916800.0;
    sum = sum * x + 1.0 / 3628800.0;
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
static inline void log1p_array(size_t count, const double *x, double *out)
{
    double largest = 0;
#pragma omp simd reduction(max : largest)
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, fabs(x[i]));
    if (largest <= SERIES_LIMIT) {
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            out[i] = log1p_series(x[i]);
    } else {
        for (size_t i = 0; i < count; i++)
            out[i] = fabs(x[i]) <= SERIES_LIMIT ? log1p_series(x[i]) : log1p(x[i]);
    }
}

#endif

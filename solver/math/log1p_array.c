/* SPDX-License-Identifier: Apache-2.0 */
#include "math/log1p_series.h"

void log1p_array(size_t count, const real *x, real *out)
{
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        out[i] = elementary_log1p(x[i]);
}

void expm1_array(size_t count, const real *x, real *out)
{
    real_bits above = 0;
    for (size_t i = 0; i < count; i++)
        above |= real_mask(!(x[i] * x[i] <= EXPM1_SMALL * EXPM1_SMALL));
    if (above == 0) {
#pragma omp simd
        for (size_t i = 0; i < count; i++)
            out[i] = expm1_small(x[i]);
        return;
    }
#pragma omp simd
    for (size_t i = 0; i < count; i++)
        out[i] = elementary_expm1(x[i]);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "math/plane_strain.h"

#include "math/log1p_series.h"

TALUS_INLINE enum tensor_range find_range(size_t components, size_t row_count, real *const a[6])
{
    real_bits above_small = 0;
    real_bits above_medium = 0;
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const real xx = a[0][slot], yy = a[1][slot], zz = a[2][slot];
        const real xy = components > 3 ? a[3][slot] : (real)0.0;
        const real square = xx * xx + yy * yy + (zz * zz + 2.0 * (xy * xy));
        above_small |= tensor_above(square, TENSOR_SMALL_LIMIT);
        above_medium |= tensor_above(square, TENSOR_MEDIUM_LIMIT);
    }
    return tensor_range_of(above_small != 0, above_medium != 0);
}

/* Slots without a result carry NAN in every component. */
static size_t count_nan(size_t row_count, real *const a[6])
{
    const real *values = a[0];
    real_bits count = 0;
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++)
        count += real_mask(!(values[slot] == values[slot])) & 1;
    return count;
}

TALUS_INLINE real log1p_in(enum tensor_range range, real x)
{
    if (range == TENSOR_SMALL)
        return log1p_small(x);
    return range == TENSOR_MEDIUM ? log1p_medium(x) : elementary_log1p(x);
}

TALUS_INLINE real expm1_in(enum tensor_range range, real x)
{
    if (range == TENSOR_SMALL)
        return expm1_small(x);
    return range == TENSOR_MEDIUM ? expm1_medium(x) : elementary_expm1(x);
}

TALUS_INLINE real root(real j)
{
    return real_sqrt(j > TENSOR_FUNCTION_TINY ? j : TENSOR_FUNCTION_TINY);
}

/* atanh(w)/w, w^2 = j */
TALUS_INLINE real atanh_share(enum tensor_range range, real j)
{
    if (range == TENSOR_SMALL)
        return 1.0 + j * (1.0 / 3.0 + j * (1.0 / 5.0));
    if (range == TENSOR_MEDIUM)
        return 1.0 + j * atanh_tail(j);
    const real w = root(j);
    return elementary_log1p(2.0 * w / (1.0 - w)) / (2.0 * w);
}

/* In the plane b = u (I + D), u = 1 + exx + eyy and D = dev(e)/(u/2), so 1/2 ln b = 1/4 ln det b I
 * + 1/2 atanh(sqrt j)/sqrt j D, and det b - 1 = u^2 (1 - j) - 1 without cancellation. */
TALUS_INLINE void log_kernel(enum tensor_range range, size_t row_count, real *const e[6],
                             real *const strain[6])
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const real sum = e[0][slot] + e[1][slot];
        const real half = 0.5 * (e[0][slot] - e[1][slot]);
        const real xy = e[3][slot];
        const real square = half * half + xy * xy;
        const real u = 1.0 + sum;
        const real inverse = 1.0 / u;
        const real j = 4.0 * square * inverse * inverse;
        real x = sum * (2.0 + sum) - 4.0 * square;
        if (range == TENSOR_LARGE) {
            /* a positive determinant is not enough: turn its sign where u is negative */
            const real twice = u - real_absolute(u);
            x -= 0.5 * twice * twice;
        }
        real mean = 0.25 * log1p_in(range, x);
        real zz = 0.5 * log1p_in(range, 2.0 * e[2][slot]);
        const real linear = inverse * atanh_share(range, j);
        if (range == TENSOR_LARGE) { /* NAN in one is NAN in all */
            mean += 0.0 * (linear + zz);
            zz += 0.0 * mean;
        }
        strain[0][slot] = mean + linear * half;
        strain[1][slot] = mean - linear * half;
        strain[2][slot] = zz;
        strain[3][slot] = range == TENSOR_LARGE ? linear * xy + 0.0 * mean : linear * xy;
    }
}

size_t plane_log(size_t row_count, real *const e[6], real *const strain[6])
{
    switch (find_range(4, row_count, e)) {
    case TENSOR_SMALL:
        log_kernel(TENSOR_SMALL, row_count, e, strain);
        return 0;
    case TENSOR_MEDIUM:
        log_kernel(TENSOR_MEDIUM, row_count, e, strain);
        return 0;
    default:
        log_kernel(TENSOR_LARGE, row_count, e, strain);
        return count_nan(row_count, strain);
    }
}

TALUS_INLINE void log_diagonal_kernel(enum tensor_range range, size_t row_count, real *const e[6],
                                      real *const strain[6])
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const real xx = 0.5 * log1p_in(range, 2.0 * e[0][slot]);
        const real yy = 0.5 * log1p_in(range, 2.0 * e[1][slot]);
        const real zz = 0.5 * log1p_in(range, 2.0 * e[2][slot]);
        const real none = 0.0 * (xx + yy + zz); /* or NAN: in one is in all */
        strain[0][slot] = range == TENSOR_LARGE ? xx + none : xx;
        strain[1][slot] = range == TENSOR_LARGE ? yy + none : yy;
        strain[2][slot] = range == TENSOR_LARGE ? zz + none : zz;
    }
}

size_t plane_log_diagonal(size_t row_count, real *const e[6], real *const strain[6])
{
    switch (find_range(3, row_count, e)) {
    case TENSOR_SMALL:
        log_diagonal_kernel(TENSOR_SMALL, row_count, e, strain);
        return 0;
    case TENSOR_MEDIUM:
        log_diagonal_kernel(TENSOR_MEDIUM, row_count, e, strain);
        return 0;
    default:
        log_diagonal_kernel(TENSOR_LARGE, row_count, e, strain);
        return count_nan(row_count, strain);
    }
}

/* sinh(w)/w and cosh(w) - 1, w^2 = j */
struct hyperbolic {
    real sine_share, cosine_change;
};

TALUS_INLINE struct hyperbolic hyperbolic(enum tensor_range range, real j)
{
    if (range == TENSOR_SMALL)
        return (struct hyperbolic){1.0 + j * (1.0 / 6.0 + j * (1.0 / 120.0)),
                                   j * (0.5 + j * (1.0 / 24.0 + j * (1.0 / 720.0)))};
    if (range == TENSOR_MEDIUM) {
        const real sine = 1.0 / 6.0 + j * (1.0 / 120.0 + j * (1.0 / 5040.0 + j / 362880.0));
        const real cosine =
            1.0 / 24.0 + j * (1.0 / 720.0 + j * (1.0 / 40320.0 + j * (1.0 / 3628800.0)));
        return (struct hyperbolic){1.0 + j * sine, j * (0.5 + j * cosine)};
    }
    const real w = root(j);
    const real change = elementary_expm1(w);
    const real rise = change / w;
    const real fall = rise / (1.0 + change); /* (1 - exp(-w))/w */
    return (struct hyperbolic){0.5 * (rise + fall), 0.5 * j * (rise * fall)};
}

/* In the plane, with A = 2 dev strain and A^2 = j I: (exp(2 strain) - I)/2 = exp(2 m)/2 (cosh(sqrt
 * j)
 * - 1) I + exp(2 m)/2 sinh(sqrt j)/sqrt j A + (exp(2 m) - 1)/2 I. */
TALUS_INLINE void exp_kernel(enum tensor_range range, size_t row_count, real *const strain[6],
                             real *const e[6])
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const real half = 0.5 * (strain[0][slot] - strain[1][slot]);
        const real xy = strain[3][slot];
        const real mean_change = expm1_in(range, strain[0][slot] + strain[1][slot]);
        const struct hyperbolic of = hyperbolic(range, 4.0 * (half * half + xy * xy));
        const real scale = 1.0 + mean_change;
        const real mean = 0.5 * (mean_change + scale * of.cosine_change);
        const real linear = scale * of.sine_share;
        e[0][slot] = mean + linear * half;
        e[1][slot] = mean - linear * half;
        e[2][slot] = 0.5 * expm1_in(range, 2.0 * strain[2][slot]);
        e[3][slot] = linear * xy;
    }
}

size_t plane_exp(size_t row_count, real *const strain[6], real *const e[6])
{
    switch (find_range(4, row_count, strain)) {
    case TENSOR_SMALL:
        exp_kernel(TENSOR_SMALL, row_count, strain, e);
        break;
    case TENSOR_MEDIUM:
        exp_kernel(TENSOR_MEDIUM, row_count, strain, e);
        break;
    default:
        exp_kernel(TENSOR_LARGE, row_count, strain, e);
    }
    return 0;
}

TALUS_INLINE void exp_diagonal_kernel(enum tensor_range range, size_t row_count,
                                      real *const strain[6], real *const e[6])
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        e[0][slot] = 0.5 * expm1_in(range, 2.0 * strain[0][slot]);
        e[1][slot] = 0.5 * expm1_in(range, 2.0 * strain[1][slot]);
        e[2][slot] = 0.5 * expm1_in(range, 2.0 * strain[2][slot]);
    }
}

size_t plane_exp_diagonal(size_t row_count, real *const strain[6], real *const e[6])
{
    switch (find_range(3, row_count, strain)) {
    case TENSOR_SMALL:
        exp_diagonal_kernel(TENSOR_SMALL, row_count, strain, e);
        break;
    case TENSOR_MEDIUM:
        exp_diagonal_kernel(TENSOR_MEDIUM, row_count, strain, e);
        break;
    default:
        exp_diagonal_kernel(TENSOR_LARGE, row_count, strain, e);
    }
    return 0;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "math/log_strain.h"

#include "math/log1p_series.h"
#include "math/plane_strain.h"
#include "math/tensor_chunk.h"

/* Smallest eigenvalue of b, in shares of their mean, that the closed form takes: it loses digits
 * as the inverse. */
static const real least_share = 0.1;

/* The c1 and c2 of ln(I + D) = D (I - D/2 + D^2/3 - ...). */
TALUS_INLINE struct combination log_small(struct invariants of)
{
    struct combination sum = {-1.0 / 4.0, 1.0 / 5.0, -1.0 / 6.0};
    sum = combination_step(sum, 1.0 / 3.0, of);
    sum = combination_step(sum, -1.0 / 2.0, of);
    sum = combination_step(sum, 1.0, of);
    return combination_shift(sum, of);
}

/* The polynomial that meets ln(1 + x) in Chebyshev's points of -0.09 < x < 0.08: relative error
 * 3e-17 with three terms less than the series. */
TALUS_INLINE struct combination log_medium(struct invariants of)
{
    struct combination sum = {-0.099930848444378467, 0.0922072622498325, -0.088976141361888444};
    sum = combination_step(sum, 0.11110337108235861, of);
    sum = combination_step(sum, -0.12500030322879327, of);
    sum = combination_step(sum, 0.14285716199227788, of);
    sum = combination_step(sum, -0.16666666617125911, of);
    sum = combination_step(sum, 0.19999999998314508, of);
    sum = combination_step(sum, -0.25000000000021511, of);
    sum = combination_step(sum, 0.33333333333333576, of);
    sum = combination_step(sum, -0.5, of);
    sum = combination_step(sum, 1.0, of);
    return combination_shift(sum, of);
}

/* b = I + 2 e = u (I + D), where u is the mean of its eigenvalues. */
struct normalised {
    struct invariants of;    /* of D */
    real inverse;            /* 1/u; D = 2/u dev e */
    real determinant_change; /* det b - 1 = u^3 (1 - J2 + J3) - 1, without cancellation */
};

TALUS_INLINE struct normalised normalise(const struct tensor_chunk *chunk, size_t slot)
{
    const real q = 2.0 * chunk->mean[slot];
    const real J2 = 4.0 * chunk->J2[slot];
    const real J3 = 8.0 * chunk->J3[slot];
    const real inverse = 1.0 / (1.0 + q);
    const real inverse2 = inverse * inverse;
    return (struct normalised){.of = {inverse2 * J2, inverse2 * inverse * J3},
                               .inverse = inverse,
                               .determinant_change =
                                   q * (3.0 + q * (3.0 + q)) + (J3 - (1.0 + q) * J2)};
}

/* 1/2 ln b = 1/6 ln det b I + 1/2 dev ln(I + D), with D^2 = (D^2 - J2 I) + J2 I and tr D^2 = 2 J2.
 */
TALUS_INLINE void set_coefficients(struct tensor_chunk *chunk, size_t slot, real log_determinant,
                                   real inverse, struct combination log)
{
    const real square = 2.0 * inverse * inverse * log.c2;
    chunk->linear[slot] = inverse * log.c1;
    chunk->square[slot] = square;
    chunk->diagonal[slot] = (1.0 / 6.0) * log_determinant + (1.0 / 3.0) * chunk->J2[slot] * square;
}

static void find_small(struct tensor_chunk *chunk, size_t row_count)
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const struct normalised b = normalise(chunk, slot);
        set_coefficients(chunk, slot, log1p_small(b.determinant_change), b.inverse,
                         log_small(b.of));
    }
}

static void find_medium(struct tensor_chunk *chunk, size_t row_count)
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const struct normalised b = normalise(chunk, slot);
        set_coefficients(chunk, slot, log1p_medium(b.determinant_change), b.inverse,
                         log_medium(b.of));
    }
}

/* Eigenvalues a, b of each D and the logarithms of (1 + a)/(1 + b) and (1 + b)/(1 + c), c = -a - b,
 * and of det b: pass by pass, because each is long. */
struct roots {
    _Alignas(64) real a[TENSOR_CHUNK];
    _Alignas(64) real b[TENSOR_CHUNK];
    _Alignas(64) real log_ab[TENSOR_CHUNK];
    _Alignas(64) real log_bc[TENSOR_CHUNK];
    _Alignas(64) real log_determinant[TENSOR_CHUNK];
};

static void find_roots(const struct tensor_chunk *chunk, size_t row_count, struct roots *roots)
{
    const size_t count = TENSOR_ROW * row_count;
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        const struct normalised b = normalise(chunk, slot);
        const struct eigenvalues at = traceless_eigenvalues(b.of);
        roots->a[slot] = at.far;
        roots->b[slot] = at.middle;
        roots->log_ab[slot] = (at.far - at.middle) / (1.0 + at.middle);
        roots->log_bc[slot] = (at.middle - at.last) / (1.0 + at.last);
        roots->log_determinant[slot] = b.determinant_change;
    }
    log1p_array(count, roots->log_ab, roots->log_ab);
    log1p_array(count, roots->log_bc, roots->log_bc);
    log1p_array(count, roots->log_determinant, roots->log_determinant);
}

/* Newton's interpolation between the eigenvalues: f = f(a) + f_ab (D - a) + f_abc (D - a)(D - b).
 */
static void find_large(struct tensor_chunk *chunk, size_t row_count, real_bits *beyond)
{
    struct roots roots;
    find_roots(chunk, row_count, &roots);
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const real inverse = normalise(chunk, slot).inverse;
        const real a = roots.a[slot];
        const real b = roots.b[slot];
        const real c = -a - b;
        const real slope_ab = roots.log_ab[slot] / (a - b);
        const real slope_bc = b == c ? 1.0 / (1.0 + c) : roots.log_bc[slot] / (b - c);
        const real square = (slope_ab - slope_bc) / (a - c);
        const struct combination log = {.c1 = slope_ab + square * c, .c2 = square};
        const real least = a < c ? a : c;
        set_coefficients(chunk, slot, roots.log_determinant[slot], inverse, log);
        beyond[slot] = real_mask(!(inverse > 0.0)) | real_mask(!(least >= least_share - 1.0));
    }
}

/* Not finite where b has no logarithm. */
static real half_log1p(real value)
{
    return 0.5 * elementary_log1p(2.0 * value);
}

static const struct tensor_function log_function = {find_small, find_medium, find_large,
                                                    half_log1p};

static size_t log_large(struct tensor_chunk *chunk, size_t row_count, real *const *e,
                        real *const *strain)
{
    return tensor_chunk_apply_large(&log_function, chunk, row_count, e, strain);
}

static size_t log_chunk(size_t row_count, real *const e[6], real *const strain[6])
{
    return tensor_chunk_apply(&log_function, log_large, row_count, e, strain);
}

size_t log_strain_batch(size_t count, size_t component_count, real *const e[6],
                        real *const strain[6])
{
    if (component_count == 3)
        return tensor_apply(plane_log_diagonal, 3, count, e, strain);
    if (component_count == 4)
        return tensor_apply(plane_log, 4, count, e, strain);
    return tensor_apply(log_chunk, 6, count, e, strain);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "math/log1p_series.h"
#include "math/log_strain.h"
#include "math/plane_strain.h"
#include "math/tensor_chunk.h"

/* Norms of the strain up to which the series below serve, and up to which rounding in the closed
 * form stays as small as the exponential's own. */
#ifdef TALUS_SINGLE
static const real small_limit = 0.02;
static const real medium_limit = 0.05;
#else
static const real small_limit = 1.5e-3;
static const real medium_limit = 0.05;
#endif
static const real large_limit = 10.0;

/* exp(A) - I = A (I + A/2! + A^2/3! + ...) */
TALUS_INLINE struct combination exp_small(struct invariants of)
{
    struct combination sum = {1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0};
    sum = combination_step(sum, 1.0 / 6.0, of);
    sum = combination_step(sum, 1.0 / 2.0, of);
    sum = combination_step(sum, 1.0, of);
    return combination_shift(sum, of);
}

TALUS_INLINE struct combination exp_medium(struct invariants of)
{
    struct combination sum = {1.0 / 40320.0, 1.0 / 362880.0, 1.0 / 3628800.0};
    sum = combination_step(sum, 1.0 / 5040.0, of);
    sum = combination_step(sum, 1.0 / 720.0, of);
    sum = combination_step(sum, 1.0 / 120.0, of);
    sum = combination_step(sum, 1.0 / 24.0, of);
    sum = combination_step(sum, 1.0 / 6.0, of);
    sum = combination_step(sum, 1.0 / 2.0, of);
    sum = combination_step(sum, 1.0, of);
    return combination_shift(sum, of);
}

/* Newton's interpolation between the eigenvalues a, b, c; exp of the lowest two from that of c. */
TALUS_INLINE struct combination exp_large(struct invariants of)
{
    const struct eigenvalues at = traceless_eigenvalues(of);
    const real ab = at.far - at.middle;
    const real bc = at.middle - at.last;
    const real c_change = elementary_expm1(at.last);
    const real bc_change = ((real)1.0 + c_change) * elementary_expm1(bc);
    const real b_change = c_change + bc_change;
    const real ab_change = ((real)1.0 + b_change) * elementary_expm1(ab);
    const real slope_ab = ab == 0.0 ? (real)1.0 + b_change : ab_change / ab;
    const real slope_bc = bc == 0.0 ? (real)1.0 + c_change : bc_change / bc;
    const real square = (slope_ab - slope_bc) / (at.far - at.last);
    const real c0 = b_change - slope_ab * at.middle + square * at.far * at.middle;
    return (struct combination){of.J2 > TENSOR_FUNCTION_TINY ? c0 : (real)0.0,
                                slope_ab + square * at.last, square};
}

/* With A = 2 dev strain: (exp(2 strain) - I)/2 = exp(2 m) (exp(A) - I)/2 + (exp(2 m) - 1)/2 I. */
TALUS_INLINE void set_coefficients(struct tensor_chunk *chunk, size_t slot, real mean_change,
                                   struct combination exp)
{
    const real scale = 1.0 + mean_change;
    const real square = 2.0 * (scale * exp.c2);
    chunk->linear[slot] = scale * exp.c1;
    chunk->square[slot] = square;
    chunk->diagonal[slot] = 0.5 * (mean_change + scale * exp.c0) + square * chunk->J2[slot];
}

TALUS_INLINE struct invariants doubled(const struct tensor_chunk *chunk, size_t slot)
{
    return (struct invariants){4.0 * chunk->J2[slot], 8.0 * chunk->J3[slot]};
}

static void find_small(struct tensor_chunk *chunk, size_t row_count)
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++)
        set_coefficients(chunk, slot, expm1_small(2.0 * chunk->mean[slot]),
                         exp_small(doubled(chunk, slot)));
}

static void find_medium(struct tensor_chunk *chunk, size_t row_count)
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++)
        set_coefficients(chunk, slot, expm1_medium(2.0 * chunk->mean[slot]),
                         exp_medium(doubled(chunk, slot)));
}

static void find_large(struct tensor_chunk *chunk, size_t row_count, real_bits *beyond)
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const real mean = chunk->mean[slot];
        const real square = 3.0 * mean * mean + 2.0 * chunk->J2[slot];
        beyond[slot] = real_mask(!(square <= large_limit * large_limit));
        set_coefficients(chunk, slot, elementary_expm1(2.0 * mean),
                         exp_large(doubled(chunk, slot)));
    }
}

/* Not finite where the exponential is too large a number. */
static real half_expm1(real value)
{
    return 2.0 * value < ELEMENTARY_EXP_LIMIT ? 0.5 * elementary_expm1(2.0 * value) : (real)NAN;
}

static size_t exp_large_chunk(struct tensor_chunk *chunk, size_t row_count, real *const strain[6],
                              real *const e[6])
{
    struct tensor_chunk_rest rest;
    tensor_chunk_rest_copy(&rest, row_count, strain);
    find_large(chunk, row_count, rest.marked);
    tensor_chunk_combine(chunk, row_count, strain, e);
    return tensor_chunk_rest_apply(&rest, row_count, half_expm1, e);
}

static size_t exp_chunk(size_t row_count, real *const strain[6], real *const e[6])
{
    struct tensor_chunk chunk;
    const enum tensor_range range =
        tensor_chunk_split(&chunk, row_count, strain, small_limit, medium_limit);
    if (range == TENSOR_LARGE)
        return exp_large_chunk(&chunk, row_count, strain, e);
    if (range == TENSOR_SMALL)
        find_small(&chunk, row_count);
    else
        find_medium(&chunk, row_count);
    tensor_chunk_combine(&chunk, row_count, strain, e);
    return 0;
}

void exp_strain_batch(size_t count, size_t component_count, real *const strain[6], real *const e[6])
{
    if (component_count == 3)
        (void)tensor_apply(plane_exp_diagonal, 3, count, strain, e);
    else if (component_count == 4)
        (void)tensor_apply(plane_exp, 4, count, strain, e);
    else
        (void)tensor_apply(exp_chunk, 6, count, strain, e);
}

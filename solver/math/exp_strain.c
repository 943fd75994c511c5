/* SPDX-License-Identifier: Apache-2.0 */
#include "math/log1p_series.h"
#include "math/log_strain.h"
#include "math/plane_strain.h"
#include "math/tensor_chunk.h"

/* Norm of the strain up to which rounding in the closed form stays as small as the exponential's
 * own. */
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

/* Eigenvalues a, b of each A and exp - 1 of c = -a - b, of the distances and of twice the mean:
 * pass by pass, because each is long. */
struct roots {
    _Alignas(64) real a[TENSOR_CHUNK];
    _Alignas(64) real b[TENSOR_CHUNK];
    _Alignas(64) real exp_ab[TENSOR_CHUNK];
    _Alignas(64) real exp_bc[TENSOR_CHUNK];
    _Alignas(64) real exp_c[TENSOR_CHUNK];
    _Alignas(64) real exp_mean[TENSOR_CHUNK];
};

static void find_roots(const struct tensor_chunk *chunk, size_t row_count, struct roots *roots)
{
    const size_t count = TENSOR_ROW * row_count;
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        const struct eigenvalues at = traceless_eigenvalues(doubled(chunk, slot));
        roots->a[slot] = at.far;
        roots->b[slot] = at.middle;
        roots->exp_ab[slot] = at.far - at.middle;
        roots->exp_bc[slot] = at.middle - at.last;
        roots->exp_c[slot] = at.last;
        roots->exp_mean[slot] = 2.0 * chunk->mean[slot];
    }
    expm1_array(count, roots->exp_ab, roots->exp_ab);
    expm1_array(count, roots->exp_bc, roots->exp_bc);
    expm1_array(count, roots->exp_c, roots->exp_c);
    expm1_array(count, roots->exp_mean, roots->exp_mean);
}

/* Newton's interpolation between the eigenvalues: f = f(a) + f_ab (A - a) + f_abc (A - a)(A - b),
 * or from f(b) as well; the exponentials of a and b from that of c. */
static void find_large(struct tensor_chunk *chunk, size_t row_count, real_bits *beyond)
{
    struct roots roots;
    find_roots(chunk, row_count, &roots);
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const real a = roots.a[slot];
        const real b = roots.b[slot];
        const real c = -a - b;
        const real exp_c = 1.0 + roots.exp_c[slot];
        const real change_bc = exp_c * roots.exp_bc[slot];
        const real change_b = roots.exp_c[slot] + change_bc;
        const real change_ab = ((real)1.0 + change_b) * roots.exp_ab[slot];
        const real slope_ab = change_ab / (a - b);
        const real slope_bc = b == c ? exp_c : change_bc / (b - c);
        const real square = (slope_ab - slope_bc) / (a - c);
        const real c0 = change_b - slope_ab * b + square * a * b;
        const real J2 = chunk->J2[slot];
        const real mean = chunk->mean[slot];
        beyond[slot] = tensor_above(3.0 * mean * mean + 2.0 * J2, large_limit);
        set_coefficients(chunk, slot, roots.exp_mean[slot],
                         (struct combination){J2 > TENSOR_FUNCTION_TINY ? c0 : (real)0.0,
                                              slope_ab + square * c, square});
    }
}

/* Not finite where the exponential is too large a number. */
static real half_expm1(real value)
{
    return 2.0 * value < ELEMENTARY_EXP_LIMIT ? 0.5 * elementary_expm1(2.0 * value) : (real)NAN;
}

static const struct tensor_function exp_function = {find_small, find_medium, find_large,
                                                    half_expm1};

static size_t exp_large(struct tensor_chunk *chunk, size_t row_count, real *const *strain,
                        real *const *e)
{
    return tensor_chunk_apply_large(&exp_function, chunk, row_count, strain, e);
}

static size_t exp_chunk(size_t row_count, real *const strain[6], real *const e[6])
{
    return tensor_chunk_apply(&exp_function, exp_large, row_count, strain, e);
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

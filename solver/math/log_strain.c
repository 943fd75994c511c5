/* SPDX-License-Identifier: Apache-2.0 */
#include "math/log_strain.h"

#include "math/eigen.h"

#include <stdbool.h>

/* Slots between the SIMD loop and the one that mends what the series does not reach. */
enum { CHUNK = 64 };

/* Largest norm of X or of the Hencky strain that the series below are cut for (6e-18, 4e-17). */
static const double series_limit = 0.1;

TALUS_INLINE struct sym3 load(double *const array[6], size_t slot, size_t components)
{
    struct sym3 a = {.xx = array[0][slot], .yy = array[1][slot], .zz = array[2][slot]};
    if (components > 3)
        a.xy = array[3][slot];
    if (components > 4) {
        a.yz = array[4][slot];
        a.xz = array[5][slot];
    }
    return a;
}

TALUS_INLINE void store(double *const array[6], size_t slot, size_t components, struct sym3 a)
{
    array[0][slot] = a.xx;
    array[1][slot] = a.yy;
    array[2][slot] = a.zz;
    if (components > 3)
        array[3][slot] = a.xy;
    if (components > 4) {
        array[4][slot] = a.yz;
        array[5][slot] = a.xz;
    }
}

/* a b for symmetric matrices that commute, so that the product is symmetric. */
TALUS_INLINE struct sym3 product(struct sym3 a, struct sym3 b, size_t components)
{
    struct sym3 c = {.xx = a.xx * b.xx, .yy = a.yy * b.yy, .zz = a.zz * b.zz};
    if (components > 3) {
        c.xx += a.xy * b.xy;
        c.yy += a.xy * b.xy;
        c.xy = a.xx * b.xy + a.xy * b.yy;
    }
    if (components > 4) {
        c.xx += a.xz * b.xz;
        c.yy += a.yz * b.yz;
        c.zz += a.xz * b.xz + a.yz * b.yz;
        c.xy += a.xz * b.yz;
        c.yz = a.xy * b.xz + a.yy * b.yz + a.yz * b.zz;
        c.xz = a.xx * b.xz + a.xy * b.yz + a.xz * b.zz;
    }
    return c;
}

TALUS_INLINE struct sym3 inverse(struct sym3 a, size_t components)
{
    if (components == 3)
        return (struct sym3){.xx = 1.0 / a.xx, .yy = 1.0 / a.yy, .zz = 1.0 / a.zz};
    if (components == 4) {
        double scale = 1.0 / (a.xx * a.yy - a.xy * a.xy);
        return (struct sym3){
            .xx = a.yy * scale, .yy = a.xx * scale, .zz = 1.0 / a.zz, .xy = -a.xy * scale};
    }
    struct sym3 adjugate = {a.yy * a.zz - a.yz * a.yz, a.xx * a.zz - a.xz * a.xz,
                            a.xx * a.yy - a.xy * a.xy, a.xz * a.yz - a.xy * a.zz,
                            a.xy * a.xz - a.xx * a.yz, a.xy * a.yz - a.yy * a.xz};
    double determinant = a.xx * adjugate.xx + a.xy * adjugate.xy + a.xz * adjugate.xz;
    return sym3_scale(1.0 / determinant, adjugate);
}

/* c0 + c1 y + c2 y^2 */
TALUS_INLINE struct sym3 quadratic(double c0, double c1, double c2, struct sym3 y, struct sym3 y2)
{
    return sym3_add_diagonal(sym3_add_scaled(sym3_scale(c1, y), c2, y2), c0);
}

/* 1/2 ln((I + X)/(I - X)) = X (1 + Y/3 + Y^2/5 + ...), Y = X^2, with X = e (I + e)^-1: half of the
 * terms that a series in e would need. */
TALUS_INLINE struct sym3 atanh_series(struct sym3 x, size_t components)
{
    struct sym3 y = product(x, x, components);
    struct sym3 y2 = product(y, y, components);
    struct sym3 y3 = product(y2, y, components);
    struct sym3 sum = sym3_add_diagonal(sym3_scale(1.0 / 15.0, y), 1.0 / 13.0);
    sum =
        sym3_add(product(sum, y3, components), quadratic(1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, y, y2));
    sum = sym3_add(product(sum, y3, components), quadratic(1.0, 1.0 / 3.0, 1.0 / 5.0, y, y2));
    return product(sum, x, components);
}

/* (exp(2 a) - I)/2 = a (1 + A/2! + A^2/3! + ...), A = 2 a. */
TALUS_INLINE struct sym3 expm1_series(struct sym3 a, size_t components)
{
    struct sym3 y = sym3_scale(2.0, a);
    struct sym3 y2 = product(y, y, components);
    struct sym3 y3 = product(y2, y, components);
    struct sym3 sum = quadratic(1.0 / 3628800.0, 1.0 / 39916800.0, 1.0 / 479001600.0, y, y2);
    sum = sym3_add(product(sum, y3, components),
                   quadratic(1.0 / 5040.0, 1.0 / 40320.0, 1.0 / 362880.0, y, y2));
    sum = sym3_add(product(sum, y3, components),
                   quadratic(1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, y, y2));
    sum = sym3_add(product(sum, y3, components), quadratic(1.0, 1.0 / 2.0, 1.0 / 6.0, y, y2));
    return product(sum, a, components);
}

TALUS_INLINE struct sym3 select(double condition, struct sym3 a, struct sym3 b)
{
    return (struct sym3){
        condition != 0.0 ? a.xx : b.xx, condition != 0.0 ? a.yy : b.yy,
        condition != 0.0 ? a.zz : b.zz, condition != 0.0 ? a.xy : b.xy,
        condition != 0.0 ? a.yz : b.yz, condition != 0.0 ? a.xz : b.xz,
    };
}

/* One slot by eigenvalues. Returns 1 and NAN where b has no logarithm. */
static size_t log_strain_spectral(double *const strain[6], size_t slot, size_t components)
{
    double values[3];
    struct mat3 vectors;
    size_t failed = 0;
    sym3_eigen(load(strain, slot, components), values, &vectors);
    for (int index = 0; index < 3; index++) {
        bool positive = values[index] > -0.5 && values[index] < (double)INFINITY;
        failed |= positive ? 0 : 1;
        values[index] = positive ? 0.5 * log1p(2.0 * values[index]) : (double)NAN;
    }
    struct sym3 result = sym3_from_eigen(values, &vectors);
    if (failed != 0)
        result = (struct sym3){NAN, NAN, NAN, NAN, NAN, NAN};
    store(strain, slot, components, result);
    return failed;
}

/* Slots outside of the series pass through unchanged and are done again one by one, from the result
 * array: so that it may be the input. */
TALUS_INLINE size_t log_strain_kernel(size_t count, size_t components, double *const e[6],
                                      double *const strain[6])
{
    double limit = series_limit * series_limit;
    size_t failed = 0;
    for (size_t begin = 0; begin < count; begin += CHUNK) {
        size_t end = count - begin < CHUNK ? count : begin + CHUNK;
        double large[CHUNK];
        double large_count = 0.0;
#pragma omp simd
        for (size_t slot = begin; slot < end; slot++) {
            struct sym3 given = load(e, slot, components);
            struct sym3 x =
                product(given, inverse(sym3_add_diagonal(given, 1.0), components), components);
            /* every b that is not positive definite has |X| > 1 or NAN */
            double is_large = sym3_dot(x, x) <= limit ? 0.0 : 1.0;
            store(strain, slot, components, select(is_large, given, atanh_series(x, components)));
            large[slot - begin] = is_large;
        }
        for (size_t index = 0; index < end - begin; index++)
            large_count += large[index];
        for (size_t slot = begin; large_count > 0.0 && slot < end; slot++) {
            if (large[slot - begin] != 0.0)
                failed += log_strain_spectral(strain, slot, components);
        }
    }
    return failed;
}

size_t log_strain_batch(size_t count, size_t component_count, double *const e[6],
                        double *const strain[6])
{
    if (component_count == 3)
        return log_strain_kernel(count, 3, e, strain);
    if (component_count == 4)
        return log_strain_kernel(count, 4, e, strain);
    return log_strain_kernel(count, 6, e, strain);
}

static void exp_strain_spectral(double *const e[6], size_t slot, size_t components)
{
    double values[3];
    struct mat3 vectors;
    sym3_eigen(load(e, slot, components), values, &vectors);
    for (int index = 0; index < 3; index++)
        values[index] = 0.5 * expm1(2.0 * values[index]);
    store(e, slot, components, sym3_from_eigen(values, &vectors));
}

TALUS_INLINE void exp_strain_kernel(size_t count, size_t components, double *const strain[6],
                                    double *const e[6])
{
    double limit = series_limit * series_limit;
    for (size_t begin = 0; begin < count; begin += CHUNK) {
        size_t end = count - begin < CHUNK ? count : begin + CHUNK;
        double large[CHUNK];
        double large_count = 0.0;
#pragma omp simd
        for (size_t slot = begin; slot < end; slot++) {
            struct sym3 given = load(strain, slot, components);
            double is_large = sym3_dot(given, given) <= limit ? 0.0 : 1.0;
            store(e, slot, components, select(is_large, given, expm1_series(given, components)));
            large[slot - begin] = is_large;
        }
        for (size_t index = 0; index < end - begin; index++)
            large_count += large[index];
        for (size_t slot = begin; large_count > 0.0 && slot < end; slot++) {
            if (large[slot - begin] != 0.0)
                exp_strain_spectral(e, slot, components);
        }
    }
}

void exp_strain_batch(size_t count, size_t component_count, double *const strain[6],
                      double *const e[6])
{
    if (component_count == 3)
        exp_strain_kernel(count, 3, strain, e);
    else if (component_count == 4)
        exp_strain_kernel(count, 4, strain, e);
    else
        exp_strain_kernel(count, 6, strain, e);
}

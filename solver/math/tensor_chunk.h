/* SPDX-License-Identifier: Apache-2.0 */
/* A function of the symmetric tensors of many slots, one array per component. In three dimensions
 * it takes three passes over a chunk: split each tensor into mean and invariants, find the three
 * coefficients of the function, combine. One pass would be a chain of a hundred dependent
 * operations per slot, and a processor does not look far enough ahead to overlap two of them; and
 * the first pass sees how large the tensors are, so that the second can take the shortest series
 * that serves them all. */
#ifndef TALUS_TENSOR_CHUNK_H
#define TALUS_TENSOR_CHUNK_H

#include "math/tensor_function.h"

#include <stdbool.h>
#include <stddef.h>

/* Slots go in rows; a chunk is what is treated alike. */
enum { TENSOR_ROW = 4, TENSOR_CHUNK_ROWS = 16, TENSOR_CHUNK = TENSOR_ROW * TENSOR_CHUNK_ROWS };

/* By the norm, which is what the series of log_strain.c, exp_strain.c and plane_strain.c are cut
 * for: what they neglect is under half of the last digit. */
enum tensor_range { TENSOR_SMALL, TENSOR_MEDIUM, TENSOR_LARGE };

#ifdef TALUS_SINGLE
#define TENSOR_SMALL_LIMIT 0.03f
#define TENSOR_MEDIUM_LIMIT 0.1f
#else
#define TENSOR_SMALL_LIMIT 1.5e-3
#define TENSOR_MEDIUM_LIMIT 0.05
#endif

/* Whether a square of a norm is above a limit, or NAN, as a mask: whole numbers gather what is true
 * of any slot faster than a largest real is found. */
TALUS_INLINE real_bits tensor_above(real square, real limit)
{
    return real_mask(!(square <= limit * limit));
}

/* From in[] to out[], which may be the same, of at most TENSOR_CHUNK_ROWS rows. Returns how many
 * slots have no result. */
typedef size_t tensor_chunk_function(size_t row_count, real *const in[6], real *const out[6]);

/* Applies a function to any number of slots; the last row is filled up with zeros. */
size_t tensor_apply_by_chunks(tensor_chunk_function *function, size_t components, size_t count,
                              real *const in[6], real *const out[6]);

/* The same; a block of a run goes straight to the function, which the compiler then knows. */
TALUS_INLINE size_t tensor_apply(tensor_chunk_function *function, size_t components, size_t count,
                                 real *const in[6], real *const out[6])
{
    if (count <= TENSOR_CHUNK && count % TENSOR_ROW == 0)
        return function(count / TENSOR_ROW, in, out);
    return tensor_apply_by_chunks(function, components, count, in, out);
}

/* Tensors a = mean I + D, and what becomes of them: diagonal I + linear D + square (D^2 - J2 I). */
struct tensor_chunk {
    _Alignas(64) real mean[TENSOR_CHUNK];
    _Alignas(64) real J2[TENSOR_CHUNK]; /* tr(D^2)/2 */
    _Alignas(64) real J3[TENSOR_CHUNK]; /* det D */
    _Alignas(64) real diagonal[TENSOR_CHUNK];
    _Alignas(64) real linear[TENSOR_CHUNK];
    _Alignas(64) real square[TENSOR_CHUNK];
};

TALUS_INLINE struct sym3 tensor_load(real *const array[6], size_t slot)
{
    return (struct sym3){array[0][slot], array[1][slot], array[2][slot],
                         array[3][slot], array[4][slot], array[5][slot]};
}

TALUS_INLINE void tensor_store(real *const array[6], size_t slot, struct sym3 a)
{
    array[0][slot] = a.xx;
    array[1][slot] = a.yy;
    array[2][slot] = a.zz;
    array[3][slot] = a.xy;
    array[4][slot] = a.yz;
    array[5][slot] = a.xz;
}

TALUS_INLINE enum tensor_range tensor_range_of(bool above_small, bool above_medium)
{
    if (above_medium)
        return TENSOR_LARGE;
    return above_small ? TENSOR_MEDIUM : TENSOR_SMALL;
}

/* First pass. A NAN is large. */
TALUS_INLINE enum tensor_range tensor_chunk_split(struct tensor_chunk *restrict chunk,
                                                  size_t row_count, real *const a[6])
{
    real_bits above_small = 0;
    real_bits above_medium = 0;
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const struct sym3 full = tensor_load(a, slot);
        const real mean = sym3_trace(full) * (1.0 / 3.0);
        const struct sym3 d = traceless_part(full, mean);
        const struct sym3 c = traceless_cofactor(d);
        const real J2 = -sym3_trace(c);
        const real square = 3.0 * mean * mean + 2.0 * J2; /* of the norm */
        chunk->mean[slot] = mean;
        chunk->J2[slot] = J2;
        chunk->J3[slot] = d.xx * c.xx + d.xy * c.xy + d.xz * c.xz;
        above_small |= tensor_above(square, TENSOR_SMALL_LIMIT);
        above_medium |= tensor_above(square, TENSOR_MEDIUM_LIMIT);
    }
    return tensor_range_of(above_small != 0, above_medium != 0);
}

/* Last pass. `result` may be `a`. */
TALUS_INLINE void tensor_chunk_combine(const struct tensor_chunk *restrict chunk, size_t row_count,
                                       real *const a[6], real *const result[6])
{
#pragma omp simd
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        const struct sym3 d = traceless_part(tensor_load(a, slot), chunk->mean[slot]);
        const struct sym3 c = traceless_cofactor(d);
        const struct sym3 sum =
            sym3_add_scaled(sym3_scale(chunk->linear[slot], d), chunk->square[slot], c);
        tensor_store(result, slot, sym3_add_diagonal(sum, chunk->diagonal[slot]));
    }
}

/* The input of a chunk, kept from being overwritten for those slots that the vectorised way does
 * not reach: they are done again one by one. */
struct tensor_chunk_rest {
    real values[6][TENSOR_CHUNK];
    real_bits marked[TENSOR_CHUNK];
};

void tensor_chunk_rest_copy(struct tensor_chunk_rest *rest, size_t row_count, real *const a[6]);

/* result = sum of function(eigenvalue) n (x) n over the eigenvectors n, for the marked slots. All
 * components are NAN, and the slot is counted, where an eigenvalue or its function is not finite.
 */
size_t tensor_chunk_rest_apply(const struct tensor_chunk_rest *rest, size_t row_count,
                               real (*function)(real), real *const result[6]);

/* Second pass of a function for one range, which leaves the coefficients in the chunk; the one for
 * large tensors also marks the slots that it does not reach. */
typedef void tensor_find(struct tensor_chunk *chunk, size_t row_count);
typedef void tensor_find_large(struct tensor_chunk *chunk, size_t row_count, real_bits *beyond);

/* What a function consists of: constants, so that the compiler sees through the pointers. */
struct tensor_function {
    tensor_find *find_small, *find_medium;
    tensor_find_large *find_large;
    real (*of_eigenvalue)(real); /* for what find_large does not reach */
};

/* Both of the last passes for large tensors. */
TALUS_INLINE size_t tensor_chunk_apply_large(const struct tensor_function *function,
                                             struct tensor_chunk *chunk, size_t row_count,
                                             real *const in[6], real *const out[6])
{
    struct tensor_chunk_rest rest;
    tensor_chunk_rest_copy(&rest, row_count, in);
    function->find_large(chunk, row_count, rest.marked);
    tensor_chunk_combine(chunk, row_count, in, out);
    return tensor_chunk_rest_apply(&rest, row_count, function->of_eigenvalue, out);
}

/* All three passes over a chunk; `large` is tensor_chunk_apply_large of the same function, in a
 * function of its own because it is long and rare. */
TALUS_INLINE size_t tensor_chunk_apply(const struct tensor_function *function,
                                       size_t (*large)(struct tensor_chunk *, size_t, real *const *,
                                                       real *const *),
                                       size_t row_count, real *const in[6], real *const out[6])
{
    struct tensor_chunk chunk;
    const enum tensor_range range = tensor_chunk_split(&chunk, row_count, in);
    if (range == TENSOR_LARGE)
        return large(&chunk, row_count, in, out);
    if (range == TENSOR_SMALL)
        function->find_small(&chunk, row_count);
    else
        function->find_medium(&chunk, row_count);
    tensor_chunk_combine(&chunk, row_count, in, out);
    return 0;
}

#endif

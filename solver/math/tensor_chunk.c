/* SPDX-License-Identifier: Apache-2.0 */
#include "math/tensor_chunk.h"

#include "math/eigen.h"

#include <string.h>

static size_t apply_part_row(tensor_chunk_function *function, size_t components, size_t count,
                             real *const in[6], real *const out[6])
{
    real values[6][TENSOR_ROW] = {{0.0}};
    real *row[6];
    for (size_t component = 0; component < 6; component++)
        row[component] = values[component];
    for (size_t component = 0; component < components; component++)
        memcpy(values[component], in[component], count * sizeof values[0][0]);
    const size_t failed = function(1, row, row);
    for (size_t component = 0; component < components; component++)
        memcpy(out[component], values[component], count * sizeof values[0][0]);
    return failed;
}

static size_t apply_from(tensor_chunk_function *function, size_t components, size_t begin,
                         size_t count, real *const in[6], real *const out[6])
{
    real *from[6] = {NULL};
    real *to[6] = {NULL};
    for (size_t component = 0; component < components; component++) {
        from[component] = in[component] + begin;
        to[component] = out[component] + begin;
    }
    if (count < TENSOR_ROW)
        return apply_part_row(function, components, count, from, to);
    return function(count / TENSOR_ROW, from, to);
}

size_t tensor_apply_by_chunks(tensor_chunk_function *function, size_t components, size_t count,
                              real *const in[6], real *const out[6])
{
    const size_t whole = count / TENSOR_ROW * TENSOR_ROW;
    size_t failed = 0;
    for (size_t begin = 0; begin < whole; begin += TENSOR_CHUNK) {
        const size_t slots = whole - begin < TENSOR_CHUNK ? whole - begin : TENSOR_CHUNK;
        failed += apply_from(function, components, begin, slots, in, out);
    }
    if (count > whole)
        failed += apply_from(function, components, whole, count - whole, in, out);
    return failed;
}

void tensor_chunk_rest_copy(struct tensor_chunk_rest *rest, size_t row_count, real *const a[6])
{
    for (size_t component = 0; component < 6; component++)
        memcpy(rest->values[component], a[component], TENSOR_ROW * row_count * sizeof(real));
}

static size_t apply_by_eigenvalues(struct sym3 *a, real (*function)(real))
{
    real values[3];
    struct mat3 vectors;
    bool failed = false;
    sym3_eigen(*a, values, &vectors);
    for (int index = 0; index < 3; index++) {
        values[index] = function(values[index]);
        failed = failed || !(real_absolute(values[index]) < (real)INFINITY);
    }
    *a = sym3_from_eigen(values, &vectors);
    if (failed)
        *a = (struct sym3){NAN, NAN, NAN, NAN, NAN, NAN};
    return failed ? 1 : 0;
}

size_t tensor_chunk_rest_apply(const struct tensor_chunk_rest *rest, size_t row_count,
                               real (*function)(real), real *const result[6])
{
    size_t failed = 0;
    for (size_t slot = 0; slot < TENSOR_ROW * row_count; slot++) {
        if (rest->marked[slot] == 0)
            continue;
        struct sym3 a = {rest->values[0][slot], rest->values[1][slot], rest->values[2][slot],
                         rest->values[3][slot], rest->values[4][slot], rest->values[5][slot]};
        failed += apply_by_eigenvalues(&a, function);
        tensor_store(result, slot, a);
    }
    return failed;
}

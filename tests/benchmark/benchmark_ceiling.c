/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_ceiling.h"

#include "benchmark_clock.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#if defined(__AVX512F__)
#define WIDEST 64
#elif defined(__AVX__)
#define WIDEST 32
#else
#define WIDEST 16
#endif

/* Chains of operations that do not wait for each other; they and two constants fit the 16 vector
 * registers of the plainer instruction sets. */
enum { CHAINS = 12, ROUNDS = 200000, ELEMENTS = 8 << 20, ARRAYS = 3 };

/* Makes the compiler believe that memory is read and written here. */
static inline void touch(void *place)
{
    __asm__ volatile("" : : "r"(place) : "memory");
}

/* Seconds for ROUNDS rounds of CHAINS operations on vectors of BYTES. */
#define DEFINE_CHAIN(NAME, SCALAR, BYTES)                                                          \
    static double NAME(double *unused)                                                             \
    {                                                                                              \
        typedef SCALAR vector __attribute__((vector_size(BYTES)));                                 \
        SCALAR factor = (SCALAR)0.999999, term = (SCALAR)1e-6;                                     \
        vector a[CHAINS] = {{0}};                                                                  \
        (void)unused;                                                                              \
        touch(&factor);                                                                            \
        touch(&term);                                                                              \
        const vector b = factor - (vector){0}, c = term - (vector){0};                             \
        const double begin = benchmark_thread_seconds();                                           \
        for (long round = 0; round < ROUNDS; round++) {                                            \
            _Pragma("GCC unroll 12")                                                               \
            for (int chain = 0; chain < CHAINS; chain++)                                           \
                a[chain] = a[chain] * b + c;                                                       \
        }                                                                                          \
        touch(a);                                                                                  \
        return benchmark_thread_seconds() - begin;                                                 \
    }

DEFINE_CHAIN(chain_double, double, WIDEST)
DEFINE_CHAIN(chain_float, float, WIDEST)

static double triad(double *memory)
{
    double *restrict a = memory;
    const double *restrict b = memory + ELEMENTS, *restrict c = memory + 2 * ELEMENTS;
    const double begin = benchmark_thread_seconds();
    for (long index = 0; index < ELEMENTS; index++)
        a[index] = b[index] + 0.5 * c[index];
    touch(memory);
    return benchmark_thread_seconds() - begin;
}

static double in_place(double *memory)
{
    const double begin = benchmark_thread_seconds();
    for (long index = 0; index < ELEMENTS; index++)
        memory[index] *= 0.999999;
    touch(memory);
    return benchmark_thread_seconds() - begin;
}

static const struct {
    double amount; /* operations or bytes of a call */
    double (*seconds)(double *memory);
} kinds[CEILING_COUNT] = {
    [CEILING_DOUBLE] = {2.0 * CHAINS * ROUNDS * (WIDEST / 8.0), chain_double},
    [CEILING_FLOAT] = {2.0 * CHAINS * ROUNDS * (WIDEST / 4.0), chain_float},
    [CEILING_TRIAD] = {24.0 * ELEMENTS, triad},
    [CEILING_IN_PLACE] = {16.0 * ELEMENTS, in_place},
};

static double *memory_of(const struct ceiling *ceiling, int thread)
{
    return ceiling->memory + (size_t)thread * ARRAYS * ELEMENTS;
}

bool ceiling_create(struct ceiling *ceiling, int threads)
{
    ceiling->threads = threads;
    ceiling->memory = malloc((size_t)threads * ARRAYS * ELEMENTS * sizeof *ceiling->memory);
    if (ceiling->memory == NULL)
        return false;
#pragma omp parallel num_threads(threads)
    {
        double *memory = memory_of(ceiling, omp_get_thread_num());
        for (long index = 0; index < (long)ARRAYS * ELEMENTS; index++)
            memory[index] = 1.0;
    }
    return true;
}

void ceiling_release(struct ceiling *ceiling)
{
    free(ceiling->memory);
    memset(ceiling, 0, sizeof *ceiling);
}

double ceiling_measure(const struct ceiling *ceiling, enum ceiling_kind kind, int threads,
                       int tries)
{
    double best = 0;
    for (int round = 0; round < tries; round++) {
        double total = 0;
#pragma omp parallel num_threads(threads) reduction(+ : total)
        {
#pragma omp barrier
            total +=
                kinds[kind].amount / kinds[kind].seconds(memory_of(ceiling, omp_get_thread_num()));
        }
        best = fmax(best, total);
    }
    return 1e-9 * best / threads;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Hencky strain and its inverse against eigenvalues in long double. */
#include "math/log_strain.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SLOTS = 200 }; /* not a multiple of the chunk: the tail is tested too */

struct tensor {
    long double m[3][3];
};

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static void rotate(struct tensor *a, struct tensor *vectors, int p, int q)
{
    if (a->m[p][q] == 0.0L)
        return;
    long double theta = (a->m[q][q] - a->m[p][p]) / (2.0L * a->m[p][q]);
    long double t = (theta < 0 ? -1.0L : 1.0L) / (fabsl(theta) + sqrtl(1.0L + theta * theta));
    long double c = 1.0L / sqrtl(1.0L + t * t);
    long double s = t * c;
    for (int row = 0; row < 3; row++) {
        long double x = a->m[row][p];
        long double y = a->m[row][q];
        a->m[row][p] = c * x - s * y;
        a->m[row][q] = s * x + c * y;
    }
    for (int column = 0; column < 3; column++) {
        long double x = a->m[p][column];
        long double y = a->m[q][column];
        a->m[p][column] = c * x - s * y;
        a->m[q][column] = s * x + c * y;
        x = vectors->m[column][p];
        y = vectors->m[column][q];
        vectors->m[column][p] = c * x - s * y;
        vectors->m[column][q] = s * x + c * y;
    }
}

/* function(eigenvalues) of a symmetric tensor. */
static struct tensor apply(struct tensor a, long double (*function)(long double))
{
    struct tensor vectors = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    struct tensor result = {0};
    for (int sweep = 0; sweep < 20; sweep++) {
        rotate(&a, &vectors, 0, 1);
        rotate(&a, &vectors, 0, 2);
        rotate(&a, &vectors, 1, 2);
    }
    for (int k = 0; k < 3; k++) {
        long double value = function(a.m[k][k]);
        for (int i = 0; i < 9; i++)
            result.m[i / 3][i % 3] += value * vectors.m[i / 3][k] * vectors.m[i % 3][k];
    }
    return result;
}

static long double half_log1p(long double value)
{
    return 0.5L * log1pl(2.0L * value);
}

static long double half_expm1(long double value)
{
    return 0.5L * expm1l(2.0L * value);
}

struct arrays {
    double values[6][SLOTS];
    double *of[6];
};

static void arrays_init(struct arrays *arrays)
{
    memset(arrays, 0, sizeof *arrays);
    for (int component = 0; component < 6; component++)
        arrays->of[component] = arrays->values[component];
}

static struct tensor arrays_get(const struct arrays *arrays, int slot)
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    struct tensor a;
    for (int i = 0; i < 9; i++)
        a.m[i / 3][i % 3] = (long double)arrays->values[place[i / 3][i % 3]][slot];
    return a;
}

static long double distance(struct tensor a, struct tensor b)
{
    long double sum = 0.0L;
    for (int i = 0; i < 9; i++) {
        long double d = a.m[i / 3][i % 3] - b.m[i / 3][i % 3];
        sum += d * d;
    }
    return sqrtl(sum);
}

/* Random tensors of a given size; every fourth with repeated eigenvalues, every eighth spherical.
 */
static void fill(struct arrays *arrays, size_t components, double size, uint64_t *state)
{
    arrays_init(arrays);
    for (int slot = 0; slot < SLOTS; slot++) {
        for (size_t component = 0; component < components; component++)
            arrays->values[component][slot] = size * (2.0 * uniform(state) - 1.0);
        if (slot % 4 == 0) {
            double value = arrays->values[0][slot];
            for (size_t component = 1; component < components; component++)
                arrays->values[component][slot] = component < 3 ? value : 0.0;
            if (slot % 8 == 0)
                arrays->values[2][slot] = -0.5 * value;
        }
    }
}

static void check_against_reference(size_t components, double size, uint64_t *state)
{
    struct arrays e;
    struct arrays strain;
    struct arrays back;
    struct tensor zero = {0};
    fill(&e, components, size, state);
    arrays_init(&strain);
    arrays_init(&back);
    assert_int_equal(log_strain_batch(SLOTS, components, e.of, strain.of), 0);
    exp_strain_batch(SLOTS, components, strain.of, back.of);
    for (int slot = 0; slot < SLOTS; slot++) {
        struct tensor exact = apply(arrays_get(&e, slot), half_log1p);
        struct tensor inverse = apply(arrays_get(&strain, slot), half_expm1);
        long double norm = distance(exact, zero);
        assert_true(distance(arrays_get(&strain, slot), exact) <= 1e-14L * norm);
        norm = distance(inverse, zero);
        assert_true(distance(arrays_get(&back, slot), inverse) <= 1e-14L * norm);
    }
}

static void test_reference(void **context)
{
    (void)context;
    const size_t components[] = {3, 4, 6};
    const double sizes[] = {1e-12, 1e-8, 1e-4, 1e-2, 0.04, 0.06, 0.1, 0.15};
    uint64_t state = 1;
    for (size_t count = 0; count < 3; count++) {
        for (size_t size = 0; size < sizeof sizes / sizeof sizes[0]; size++)
            check_against_reference(components[count], sizes[size], &state);
    }
}

/* Stretches of 1/20 ... 20, in all directions. */
static void test_large(void **context)
{
    (void)context;
    struct arrays strain;
    struct arrays e;
    struct arrays back;
    struct tensor zero = {0};
    uint64_t state = 2;
    fill(&strain, 6, 1.5, &state);
    arrays_init(&e);
    arrays_init(&back);
    exp_strain_batch(SLOTS, 6, strain.of, e.of);
    assert_int_equal(log_strain_batch(SLOTS, 6, e.of, back.of), 0);
    for (int slot = 0; slot < SLOTS; slot++) {
        struct tensor exact = apply(arrays_get(&strain, slot), half_expm1);
        assert_true(distance(arrays_get(&e, slot), exact) <= 1e-14L * distance(exact, zero));
        /* b spans many orders: its smallest eigenvalue knows only the digits of the largest */
        exact = apply(arrays_get(&e, slot), half_log1p);
        assert_true(distance(arrays_get(&back, slot), exact) <= 1e-12L * distance(exact, zero));
    }
}

static void test_in_place(void **context)
{
    (void)context;
    struct arrays e;
    struct arrays strain;
    uint64_t state = 3;
    fill(&e, 6, 0.1, &state); /* on both sides of the limit of the series */
    arrays_init(&strain);
    assert_int_equal(log_strain_batch(SLOTS, 6, e.of, strain.of), 0);
    assert_int_equal(log_strain_batch(SLOTS, 6, e.of, e.of), 0);
    assert_memory_equal(e.values, strain.values, sizeof e.values);
    struct arrays back;
    arrays_init(&back);
    exp_strain_batch(SLOTS, 6, strain.of, back.of);
    exp_strain_batch(SLOTS, 6, strain.of, strain.of);
    assert_memory_equal(back.values, strain.values, sizeof back.values);
}

static void test_not_positive_definite(void **context)
{
    (void)context;
    const double bad[] = {-0.5, -0.6, -1.0, -1.4, -2.0, -30.0, NAN, INFINITY, -INFINITY};
    enum { BAD_COUNT = sizeof bad / sizeof bad[0] };
    const size_t components[] = {3, 4, 6};
    for (size_t count = 0; count < 3; count++) {
        struct arrays e;
        struct arrays strain;
        arrays_init(&e);
        arrays_init(&strain);
        for (int index = 0; index < BAD_COUNT; index++)
            e.values[index % 3][10 * index] = bad[index];
        assert_int_equal(log_strain_batch(SLOTS, components[count], e.of, strain.of), BAD_COUNT);
        for (int slot = 0; slot < SLOTS; slot++) {
            bool is_bad = slot % 10 == 0 && slot / 10 < BAD_COUNT;
            for (size_t component = 0; component < components[count]; component++)
                assert_true(is_bad ? isnan(strain.values[component][slot])
                                   : strain.values[component][slot] == 0.0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_large),
        cmocka_unit_test(test_in_place),
        cmocka_unit_test(test_not_positive_definite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

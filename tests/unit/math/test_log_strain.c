/* SPDX-License-Identifier: Apache-2.0 */
/* Hencky strain and its inverse against eigenvalues in long double; built once more with
 * TALUS_SINGLE. */
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

/* Nine half last digits: 1e-15 in double. */
static const double tolerance = 4.5 * (double)REAL_EPSILON;

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
    real values[6][SLOTS];
    real *of[6];
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
            arrays->values[component][slot] = (real)(size * (2.0 * uniform(state) - 1.0));
        if (slot % 4 == 0) {
            const real value = arrays->values[0][slot];
            for (size_t component = 1; component < components; component++)
                arrays->values[component][slot] = component < 3 ? value : 0;
            if (slot % 8 == 0)
                arrays->values[2][slot] = -value / 2;
        }
    }
}

/* Rotated tensors a I + b n (x) n: a double eigenvalue, and what rounding makes of it. */
static void fill_uniaxial(struct arrays *arrays, size_t components, double size, uint64_t *state)
{
    arrays_init(arrays);
    for (int slot = 0; slot < SLOTS; slot++) {
        double n[3] = {uniform(state) - 0.5, uniform(state) - 0.5, uniform(state) - 0.5};
        n[2] = components > 4 ? n[2] : 0.0;
        const double a = size * (uniform(state) - 0.5);
        const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        const double b = size * (uniform(state) - 0.5) / square;
        for (size_t i = 0; i < 3; i++) {
            arrays->values[i][slot] = (real)(a + b * n[i] * n[i]);
            if (components > 3 + i)
                arrays->values[3 + i][slot] = (real)(b * n[i < 2 ? i : 0] * n[i < 2 ? i + 1 : 2]);
        }
    }
}

/* Largest error of a component, in shares of the norm of the exact tensor. */
static double error_share(struct tensor value, struct tensor exact)
{
    const struct tensor zero = {0};
    const long double norm = distance(exact, zero);
    long double largest = 0.0L;
    for (int i = 0; i < 9; i++) {
        const long double error = fabsl(value.m[i / 3][i % 3] - exact.m[i / 3][i % 3]);
        largest = !(error <= largest) ? error : largest; /* keeps NAN */
    }
    return (double)(largest == 0.0L ? 0.0L : largest / norm);
}

static void assert_share(double share, double bound, const char *what, double size)
{
    if (!(share <= bound))
        fail_msg("%s of size %g: error %g of the norm, more than %g", what, size, share, bound);
}

/* Each component within the tolerance of the norm, both ways; and back within what both add up to,
 * which the condition of the second may double. */
static void check_against_reference(struct arrays *e, size_t components, double size)
{
    struct arrays strain;
    struct arrays back;
    struct arrays exponential;
    arrays_init(&strain);
    arrays_init(&back);
    arrays_init(&exponential);
    assert_int_equal(log_strain_batch(SLOTS, components, e->of, strain.of), 0);
    exp_strain_batch(SLOTS, components, strain.of, back.of);
    exp_strain_batch(SLOTS, components, e->of, exponential.of);
    for (int slot = 0; slot < SLOTS; slot++) {
        const struct tensor given = arrays_get(e, slot);
        assert_share(error_share(arrays_get(&strain, slot), apply(given, half_log1p)), tolerance,
                     "log", size);
        assert_share(error_share(arrays_get(&exponential, slot), apply(given, half_expm1)),
                     tolerance, "exp", size);
        assert_share(error_share(arrays_get(&back, slot), given), 3.0 * tolerance, "exp(log)",
                     size);
    }
}

static const size_t component_counts[] = {3, 4, 6};
enum { COMPONENT_COUNTS = sizeof component_counts / sizeof component_counts[0] };

/* Norms from the smallest strains to b with eigenvalues of 0.2, through the borders 0.0015 and 0.05
 * of the series: a tensor with components of one size has a norm up to three times that. */
static void test_reference(void **context)
{
    (void)context;
    const double smallest = (double)REAL_EPSILON < 1e-10 ? 1e-300 : 1e-34;
    const double sizes[] = {smallest, 1e-30, 1e-12, 1e-8, 1e-4,  5e-4, 8e-4, 1e-3,
                            1.4e-3,   1e-2,  0.016, 0.02, 0.025, 0.04, 0.1,  0.15};
    uint64_t state = 1;
    for (size_t count = 0; count < COMPONENT_COUNTS; count++) {
        for (size_t index = 0; index < sizeof sizes / sizeof sizes[0]; index++) {
            struct arrays e;
            fill(&e, component_counts[count], sizes[index], &state);
            check_against_reference(&e, component_counts[count], sizes[index]);
            fill_uniaxial(&e, component_counts[count], sizes[index], &state);
            check_against_reference(&e, component_counts[count], sizes[index]);
        }
    }
}

/* Small strains keep their digits beside large ones, whose way they go. */
static void test_mixed(void **context)
{
    (void)context;
    uint64_t state = 5;
    for (size_t count = 0; count < COMPONENT_COUNTS; count++) {
        struct arrays e;
        fill(&e, component_counts[count], 0.15, &state);
        for (int slot = 0; slot < SLOTS; slot++) {
            for (int component = 0; component < 6; component++)
                e.values[component][slot] *= (real)pow(10.0, -(slot % 16));
        }
        check_against_reference(&e, component_counts[count], 0.15);
    }
}

/* From strains: stretches of up to 3, in all directions, where the closed form ends for some. The
 * bound is the condition: the smallest eigenvalue of b knows only the digits of the largest. */
static void check_large(size_t components, double size, uint64_t *state)
{
    struct arrays strain;
    struct arrays e;
    struct arrays back;
    fill(&strain, components, size, state);
    arrays_init(&e);
    arrays_init(&back);
    exp_strain_batch(SLOTS, components, strain.of, e.of);
    assert_int_equal(log_strain_batch(SLOTS, components, e.of, back.of), 0);
    for (int slot = 0; slot < SLOTS; slot++) {
        const struct tensor zero = {0};
        const struct tensor given = arrays_get(&strain, slot);
        const long double norm = distance(given, zero);
        const double condition = (double)expl(4.0L * norm);
        assert_share(error_share(arrays_get(&e, slot), apply(given, half_expm1)),
                     tolerance * (1.0 + (double)norm), "exp",
                     size); /* the argument is rounded too */
        assert_share(error_share(arrays_get(&back, slot), apply(arrays_get(&e, slot), half_log1p)),
                     tolerance + 0.1 * tolerance * condition, "log", size);
    }
}

static void test_large(void **context)
{
    (void)context;
    const double sizes[] = {0.2, 0.3, 0.45, 0.6, 1.5};
    uint64_t state = 2;
    for (size_t count = 0; count < COMPONENT_COUNTS; count++) {
        for (size_t index = 0; index < sizeof sizes / sizeof sizes[0]; index++)
            check_large(component_counts[count], sizes[index], &state);
    }
}

/* The slots of a last, short row and of arrays of any alignment: the same bits. */
static void test_any_count(void **context)
{
    (void)context;
    uint64_t state = 4;
    for (size_t count = 0; count < COMPONENT_COUNTS; count++) {
        const size_t components = component_counts[count];
        struct arrays e;
        struct arrays all;
        fill(&e, components, 5e-4, &state);
        arrays_init(&all);
        assert_int_equal(log_strain_batch(64, components, e.of, all.of), 0);
        for (size_t slots = 1; slots < 10; slots++) {
            struct arrays some;
            real *in[6];
            arrays_init(&some);
            for (int component = 0; component < 6; component++)
                in[component] = e.of[component] + 3;
            assert_int_equal(log_strain_batch(slots, components, in, some.of), 0);
            for (size_t component = 0; component < 6; component++) {
                assert_memory_equal(some.values[component], &all.values[component][3],
                                    slots * sizeof(real));
                assert_true(some.values[component][slots] == 0.0);
            }
        }
    }
}

static void test_in_place(void **context)
{
    (void)context;
    struct arrays e;
    struct arrays strain;
    uint64_t state = 3;
    fill(&e, 6, 0.1, &state);
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
            e.values[index % 3][10 * index] = (real)bad[index];
        assert_int_equal(log_strain_batch(SLOTS, components[count], e.of, strain.of), BAD_COUNT);
        for (int slot = 0; slot < SLOTS; slot++) {
            bool is_bad = slot % 10 == 0 && slot / 10 < BAD_COUNT;
            for (size_t component = 0; component < components[count]; component++)
                assert_true(is_bad ? isnan(strain.values[component][slot])
                                   : strain.values[component][slot] == 0.0);
        }
    }
}

/* Shear that makes one eigenvalue of b negative, and two negative ones with a positive determinant;
 * what has no exponential that a number can hold. */
static void test_indefinite(void **context)
{
    (void)context;
    for (size_t components = 4; components <= 6; components += 2) {
        struct arrays e;
        arrays_init(&e);
        e.values[3][3] = (real)0.6;
        e.values[0][5] = e.values[1][5] = (real)-0.9;
        e.values[3][5] = (real)0.1;
        e.values[0][77] = e.values[1][77] = (real)-0.9;
        e.values[2][77] = 3;
        e.values[components - 1][130] = (real)-0.51;
        assert_int_equal(log_strain_batch(SLOTS, components, e.of, e.of), 4);
        for (size_t component = 0; component < components; component++) {
            assert_true(isnan(e.values[component][3]) && isnan(e.values[component][5]));
            assert_true(isnan(e.values[component][77]) && isnan(e.values[component][130]));
            assert_true(e.values[component][4] == 0.0 && e.values[component][131] == 0.0);
        }
    }
    struct arrays strain;
    arrays_init(&strain);
    strain.values[1][9] = NAN;
    strain.values[0][10] = (real)1e4;
    exp_strain_batch(SLOTS, 6, strain.of, strain.of);
    assert_true(isnan(strain.values[0][9]) && isnan(strain.values[3][9]));
    assert_false(fabs((double)strain.values[0][10]) < 1e30);
    assert_true(strain.values[0][11] == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference),  cmocka_unit_test(test_mixed),
        cmocka_unit_test(test_large),      cmocka_unit_test(test_any_count),
        cmocka_unit_test(test_in_place),   cmocka_unit_test(test_not_positive_definite),
        cmocka_unit_test(test_indefinite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

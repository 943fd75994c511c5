/* SPDX-License-Identifier: Apache-2.0 */
/* Sobol points against published ones and against what defines their equal distribution; Latin
 * hypercubes against theirs; both against themselves on another machine. */
#include "sampling.h"
#include "server_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double *points_make(size_t count, size_t dimensions)
{
    double *points = calloc(count * dimensions, sizeof *points);
    assert_non_null(points);
    return points;
}

/* Steele, Lea and Flood's generator: its published first numbers for the seed 1234567. */
static void test_generator(void **state)
{
    static const uint64_t expected[] = {
        UINT64_C(6457827717110365317), UINT64_C(3203168211198807973), UINT64_C(9817491932198370423),
        UINT64_C(4593380528125082431), UINT64_C(16408922859458223821)};
    uint64_t generator = 1234567;
    (void)state;
    for (size_t index = 0; index < 5; index++)
        assert_true(sampling_random(&generator) == expected[index]);
}

static void test_sobol_first_points(void **state)
{
    static const double expected[8][6] = {
        {0, 0, 0, 0, 0, 0},
        {0.5, 0.5, 0.5, 0.5, 0.5, 0.5},
        {0.75, 0.25, 0.25, 0.25, 0.75, 0.75},
        {0.25, 0.75, 0.75, 0.75, 0.25, 0.25},
        {0.375, 0.375, 0.625, 0.875, 0.375, 0.125},
        {0.875, 0.875, 0.125, 0.375, 0.875, 0.625},
        {0.625, 0.125, 0.875, 0.625, 0.625, 0.875},
        {0.125, 0.625, 0.375, 0.125, 0.125, 0.375},
    };
    double points[8 * 6];
    (void)state;
    sampling_sobol(0, 8, 6, points);
    for (size_t index = 0; index < 48; index++)
        assert_true(points[index] == expected[index / 6][index % 6]);
}

/* The checksum (FNV-1a over words) of 1024 points in 64 dimensions that SciPy 1.10 gives from the
 * published file of direction numbers. */
static void test_sobol_all_dimensions(void **state)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    double *points = points_make(1024, SOBOL_DIMENSION_MAX);
    (void)state;
    sampling_sobol(0, 1024, SOBOL_DIMENSION_MAX, points);
    for (size_t index = 0; index < (size_t)1024 * SOBOL_DIMENSION_MAX; index++)
        hash = (hash ^ (uint64_t)(points[index] * 0x1p32)) * UINT64_C(1099511628211);
    assert_true(hash == UINT64_C(0x86599089dcb62325));
    free(points);
}

/* Each axis: every aligned block of 2^k points has one in each of 2^k intervals. */
static void check_strata(const double *points, size_t count, size_t dimensions, size_t block)
{
    for (size_t axis = 0; axis < dimensions; axis++) {
        for (size_t first = 0; first < count; first += block) {
            bool *hit = calloc(block, sizeof *hit);
            assert_non_null(hit);
            for (size_t point = first; point < first + block; point++) {
                double value = points[point * dimensions + axis];
                assert_true(value >= 0.0 && value < 1.0);
                size_t stratum = (size_t)(value * (double)block);
                assert_false(hit[stratum]);
                hit[stratum] = true;
            }
            free(hit);
        }
    }
}

static void test_sobol_strata(void **state)
{
    static const uint64_t seeds[] = {0, 1, 20260101};
    double *points = points_make(1024, SOBOL_DIMENSION_MAX);
    (void)state;
    for (size_t seed = 0; seed < 3; seed++) {
        sampling_sobol(seeds[seed], 1024, SOBOL_DIMENSION_MAX, points);
        for (size_t block = 1; block <= 1024; block *= 4)
            check_strata(points, 1024, SOBOL_DIMENSION_MAX, block);
    }
    free(points);
}

/* Whether 2^m points have exactly 2^t in each elementary box of 2^(m - t) in the plane of two axes,
 * whatever the box's shape: what defines a (t, m, 2)-net in base 2. */
static bool is_net(const double *points, size_t dimensions, size_t x, size_t y, int m, int t)
{
    bool good = true;
    for (int split = 0; good && split <= m - t; split++) {
        size_t columns = (size_t)1 << split, rows = (size_t)1 << (m - t - split);
        int *boxes = calloc(columns * rows, sizeof *boxes);
        assert_non_null(boxes);
        for (size_t point = 0; point < (size_t)1 << m; point++) {
            size_t column = (size_t)(points[point * dimensions + x] * (double)columns);
            size_t row = (size_t)(points[point * dimensions + y] * (double)rows);
            boxes[column * rows + row]++;
        }
        for (size_t box = 0; box < columns * rows; box++)
            good = good && boxes[box] == 1 << t;
        free(boxes);
    }
    return good;
}

/* The quality t of a projection is at most the sum of (degree - 1) of its polynomials (Sobol 1967):
 * 0 for axes 1 and 2, 1 more with axis 3, 2 more with axes 4 and 5. */
static void test_sobol_planes(void **state)
{
    static const int degree_less_one[] = {0, 0, 1, 2, 2, 3, 3};
    static const uint64_t seeds[] = {0, 7};
    double points[256 * 7];
    (void)state;
    for (size_t seed = 0; seed < 2; seed++) {
        for (int m = 4; m <= 8; m++) {
            sampling_sobol(seeds[seed], (size_t)1 << m, 7, points);
            for (size_t x = 0; x < 7; x++) {
                for (size_t y = 0; y < x; y++) {
                    int t = degree_less_one[x] + degree_less_one[y];
                    if (t < m && !is_net(points, 7, x, y, m, t))
                        fail_msg("axes %zu and %zu, 2^%d points, t = %d", x, y, m, t);
                }
            }
        }
    }
}

static void test_seeds_differ(void **state)
{
    double first[64], second[64];
    (void)state;
    sampling_sobol(1, 16, 4, first);
    sampling_sobol(2, 16, 4, second);
    assert_memory_not_equal(first, second, sizeof first);
    sampling_latin_hypercube(1, 16, 4, first);
    sampling_latin_hypercube(2, 16, 4, second);
    assert_memory_not_equal(first, second, sizeof first);
    sampling_latin_hypercube(1, 16, 4, second);
    assert_memory_equal(first, second, sizeof first);
}

static void test_latin_strata(void **state)
{
    static const size_t counts[] = {1, 2, 3, 10, 97, 1000};
    (void)state;
    for (size_t index = 0; index < 6; index++) {
        size_t count = counts[index];
        double *points = points_make(count, 5);
        for (uint64_t seed = 0; seed < 20; seed++) {
            sampling_latin_hypercube(seed, count, 5, points);
            check_strata(points, count, 5, count);
        }
        free(points);
    }
}

/* Axes are shuffled independently: over many seeds the correlation of two has the mean 0 and, for n
 * points, the deviation 1/sqrt(n - 1). Tolerances: 4 deviations of what 400 trials leave. */
static void test_latin_independence(void **state)
{
    enum { COUNT = 26, TRIALS = 400 };
    double points[COUNT * 2], mean = 0.0, square = 0.0;
    (void)state;
    for (uint64_t seed = 1; seed <= TRIALS; seed++) {
        double xy = 0.0, xx = 0.0, yy = 0.0;
        sampling_latin_hypercube(seed, COUNT, 2, points);
        for (size_t point = 0; point < COUNT; point++) {
            double x = points[2 * point] - 0.5, y = points[2 * point + 1] - 0.5;
            xy += x * y;
            xx += x * x;
            yy += y * y;
        }
        double correlation = xy / sqrt(xx * yy);
        mean += correlation / TRIALS;
        square += correlation * correlation / TRIALS;
    }
    assert_true(fabs(mean) < 4.0 * 0.2 / sqrt(TRIALS));
    assert_true(fabs(square * (COUNT - 1) - 1.0) < 4.0 * sqrt(2.0 / TRIALS));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_generator),
        cmocka_unit_test(test_sobol_first_points),
        cmocka_unit_test(test_sobol_all_dimensions),
        cmocka_unit_test(test_sobol_strata),
        cmocka_unit_test(test_sobol_planes),
        cmocka_unit_test(test_seeds_differ),
        cmocka_unit_test(test_latin_strata),
        cmocka_unit_test(test_latin_independence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Axes are orthonormal and give the tensor back, to some units in the last place of its norm,
 * whatever values repeat or nearly do. */
#include "math/principal_axes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

static const double tolerance = 2e-15;

static void assert_small(double value)
{
    if (!(fabs(value) <= tolerance))
        fail_msg("%g is not below %g", value, tolerance);
}

/* `d`: without trace, of norm 1 or nothing. */
static void check(struct sym3 d)
{
    const struct principal_axis first = principal_apart(d);
    const struct principal_plane plane = principal_across(d, first.along);
    const struct principal_axis axes[3] = {first, principal_plane_first(plane),
                                           principal_plane_second(plane)};
    struct sym3 sum = {0};
    for (int i = 0; i < 3; i++) {
        const struct vec3 n = axes[i].along;
        const struct sym3 dyad = {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.y * n.z, n.x * n.z};
        sum = sym3_add_scaled(sum, axes[i].value, dyad);
        for (int j = 0; j <= i; j++)
            assert_small(vec3_dot(n, axes[j].along) - (i == j ? 1.0 : 0.0));
    }
    assert_small(sym3_norm(sym3_add_scaled(sum, -1.0, d)));
}

/* Uniform in [-1, 1): a linear congruence (Knuth's MMIX). */
static double random_value(uint64_t *state)
{
    *state = *state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(*state >> 11) * 0x1p-52 - 1.0;
}

/* With the values 1, -1/2 +- gap about a random direction; its opposite. */
static void check_pair(double gap, uint64_t *state)
{
    struct vec3 n = {random_value(state), random_value(state), random_value(state)};
    struct vec3 u = {random_value(state), random_value(state), random_value(state)};
    const double length = sqrt(vec3_dot(n, n));
    n = vec3_combine(1.0 / length, n, 0.0, n);
    u = vec3_combine(1.0, u, -vec3_dot(u, n), n);
    const double across = vec3_dot(u, u);
    const double g = 2.0 * gap / across;
    struct sym3 d = {1.5 * n.x * n.x - 0.5 + gap * (n.x * n.x - 1.0) + g * u.x * u.x,
                     1.5 * n.y * n.y - 0.5 + gap * (n.y * n.y - 1.0) + g * u.y * u.y,
                     1.5 * n.z * n.z - 0.5 + gap * (n.z * n.z - 1.0) + g * u.z * u.z,
                     (1.5 + gap) * n.x * n.y + g * u.x * u.y,
                     (1.5 + gap) * n.y * n.z + g * u.y * u.z,
                     (1.5 + gap) * n.x * n.z + g * u.x * u.z};
    d = sym3_deviator(d);
    d = sym3_scale(1.0 / sym3_norm(d), d);
    check(d);
    check(sym3_scale(-1.0, d));
}

static void test_random_tensors(void **context)
{
    (void)context;
    uint64_t state = 7;
    for (int trial = 0; trial < 20000; trial++) {
        struct sym3 d = {random_value(&state), random_value(&state), random_value(&state),
                         random_value(&state), random_value(&state), random_value(&state)};
        d = sym3_deviator(d);
        check(sym3_scale(1.0 / sym3_norm(d), d));
    }
}

static void test_values_that_meet(void **context)
{
    (void)context;
    const double gaps[] = {0.0, 1e-300, 1e-17, 1e-16, 1e-15, 1e-12, 1e-8, 1e-4, 0.1};
    uint64_t state = 8;
    for (size_t gap = 0; gap < sizeof gaps / sizeof gaps[0]; gap++) {
        for (int trial = 0; trial < 2000; trial++)
            check_pair(gaps[gap], &state);
    }
    const double third = 1.0 / 6.0;
    const struct sym3 along_axes[] = {
        {0},
        {sqrt(2.0 / 3.0), -sqrt(third), -sqrt(third), 0, 0, 0},
        {-sqrt(third), -sqrt(third), sqrt(2.0 / 3.0), 0, 0, 0},
        {0, 0, 0, sqrt(0.5), 0, 0},
        {0, 0, 0, 0, 0, -sqrt(0.5)},
        {0, 0, 0, sqrt(third), sqrt(third), sqrt(third)},
    };
    for (size_t index = 0; index < sizeof along_axes / sizeof along_axes[0]; index++)
        check(along_axes[index]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_tensors),
        cmocka_unit_test(test_values_that_meet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

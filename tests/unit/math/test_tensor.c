/* SPDX-License-Identifier: Apache-2.0 */
#include "math/eigen.h"
#include "math/tensor.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct sym3 sample = {2.0, -1.0, 0.5, 0.3, -0.7, 1.1};

static void assert_near(double value, double expected)
{
    assert_true(fabs(value - expected) <= 1e-14); /* a few round-offs of numbers of size 1 */
}

static void test_invariants(void **context)
{
    (void)context;
    struct mat3 full = mat3_from_sym3(sample);
    double sum = 0.0;
    for (int i = 0; i < 9; i++)
        sum += full.m[i / 3][i % 3] * full.m[i / 3][i % 3];
    assert_near(sym3_trace(sample), 1.5);
    assert_near(sym3_norm(sample), sqrt(sum));
    assert_near(sym3_trace(sym3_deviator(sample)), 0.0);
    assert_near(sym3_determinant(sample), mat3_determinant(full));
    assert_near(vec3_dot((struct vec3){1, 2, 3}, (struct vec3){4, 5, 6}), 32.0);
}

static void test_push_forward_keeps_invariants_of_rotations(void **context)
{
    (void)context;
    double c = cos(0.7);
    double s = sin(0.7);
    struct mat3 about_z = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
    struct mat3 about_x = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    struct sym3 turned = sym3_push_forward(mat3_multiply(about_z, about_x), sample);
    assert_near(sym3_trace(turned), sym3_trace(sample));
    assert_near(sym3_norm(turned), sym3_norm(sample));
    assert_near(sym3_determinant(turned), sym3_determinant(sample));
    /* a quarter turn about z takes x to y */
    struct mat3 quarter = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
    struct sym3 known = sym3_push_forward(quarter, sample);
    assert_near(known.xx, sample.yy);
    assert_near(known.yy, sample.xx);
    assert_near(known.xy, -sample.xy);
    assert_near(known.yz, sample.xz);
    assert_near(known.xz, -sample.yz);
}

static void test_eigen(void **context)
{
    (void)context;
    double values[3];
    struct mat3 vectors;
    sym3_eigen(sample, values, &vectors);
    assert_near(values[0] + values[1] + values[2], sym3_trace(sample));
    assert_near(values[0] * values[1] * values[2], sym3_determinant(sample));
    struct sym3 again = sym3_from_eigen(values, &vectors);
    assert_near(sym3_norm(sym3_add_scaled(again, -1.0, sample)), 0.0);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double dot = 0.0;
            for (int k = 0; k < 3; k++)
                dot += vectors.m[k][i] * vectors.m[k][j];
            assert_near(dot, i == j ? 1.0 : 0.0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_invariants),
        cmocka_unit_test(test_push_forward_keeps_invariants_of_rotations),
        cmocka_unit_test(test_eigen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Against the C library in long double. */
#include "math/elementary.h"
#include "math/log1p_series.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { SAMPLES = 20000 };
static const long double tolerance = 1e-15L;

static void assert_near(double value, long double exact)
{
    if (!(fabsl((long double)value - exact) <= tolerance * fabsl(exact)))
        fail_msg("%.17g instead of %.17Lg", value, exact);
}

static void test_exp(void **context)
{
    (void)context;
    for (int sample = 0; sample <= SAMPLES; sample++) {
        double share = 2.0 * sample / SAMPLES - 1.0;
        assert_near(elementary_exp(700.0 * share), expl((long double)(700.0 * share)));
        assert_near(elementary_exp(2.0 * share), expl((long double)(2.0 * share)));
        assert_near(elementary_exp(1e-9 * share), expl((long double)(1e-9 * share)));
    }
    assert_true(elementary_exp(0.0) == 1.0);
    assert_true(elementary_exp(-1e9) == elementary_exp(-700.0));
    assert_true(elementary_exp(1e9) == elementary_exp(700.0));
}

/* Within two last digits. */
static void assert_close(double value, long double exact)
{
    if (!(fabsl((long double)value - exact) <= 4.45e-16L * fabsl(exact)))
        fail_msg("%.17g instead of %.17Lg", value, exact);
}

static void test_expm1(void **context)
{
    (void)context;
    for (int sample = 0; sample <= SAMPLES; sample++) {
        const double share = 2.0 * sample / SAMPLES - 1.0;
        const double sizes[] = {700.0, 3.0, 0.5, 1e-3, 1e-12, 1e-300};
        for (size_t index = 0; index < sizeof sizes / sizeof sizes[0]; index++) {
            const double x = sizes[index] * share;
            assert_close(elementary_expm1(x), expm1l((long double)x));
        }
        assert_close(expm1_small(0.003 * share), expm1l((long double)(0.003 * share)));
        assert_close(expm1_medium(0.1 * share), expm1l((long double)(0.1 * share)));
    }
    assert_true(elementary_expm1(0.0) == 0.0 && elementary_expm1(-1e9) == -1.0);
    assert_true(isnan(elementary_expm1(NAN)));
}

static void test_log1p(void **context)
{
    (void)context;
    for (int sample = 1; sample < SAMPLES; sample++) {
        const double share = 2.0 * sample / SAMPLES - 1.0;
        const double sizes[] = {1.0, 0.5, 1e-3, 1e-12, 1e-300};
        for (size_t index = 0; index < sizeof sizes / sizeof sizes[0]; index++) {
            const double x = sizes[index] * share;
            assert_close(elementary_log1p(x), log1pl((long double)x));
        }
        const double power = ldexp(1.0 + 0.5 * share, sample % 2000 - 1000);
        assert_close(elementary_log1p(power), log1pl((long double)power));
        const double near = ldexp(1.0 + 0.5 * share, sample % 100 - 51) - 1.0; /* from -1 */
        assert_close(elementary_log1p(near), log1pl((long double)near));
        assert_close(log1p_small(0.0053 * share), log1pl((long double)(0.0053 * share)));
        const double middle = 0.015 + 0.175 * share;
        assert_close(log1p_medium(middle), log1pl((long double)middle));
    }
    const double outside[] = {-1.0, -1.5, -1e300, NAN, INFINITY, -INFINITY, 1e308};
    for (size_t index = 0; index < sizeof outside / sizeof outside[0]; index++)
        assert_true(isnan(elementary_log1p(outside[index])));
    assert_true(elementary_log1p(0.0) == 0.0);
}

static void test_arrays(void **context)
{
    (void)context;
    enum { COUNT = 37 }; /* no multiple of any vector */
    double x[COUNT];
    double logarithm[COUNT];
    double exponential[COUNT];
    for (int index = 0; index < COUNT; index++)
        x[index] = 0.03 * (index - 30);
    log1p_array(COUNT, x, logarithm);
    memcpy(exponential, x, sizeof x);
    expm1_array(COUNT, exponential, exponential);
    for (int index = 0; index < COUNT; index++) {
        assert_close(logarithm[index], log1pl((long double)x[index]));
        assert_close(exponential[index], expm1l((long double)x[index]));
    }
}

static void test_tangent(void **context)
{
    (void)context;
    const long double radians = 3.14159265358979323846264338328L / 180.0L;
    for (int sample = 0; sample < SAMPLES; sample++) {
        double angle = 89.9 * sample / SAMPLES;
        assert_near(elementary_tangent_deg(angle), tanl((long double)angle * radians));
    }
    assert_true(elementary_tangent_deg(0.0) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exp),    cmocka_unit_test(test_expm1),   cmocka_unit_test(test_log1p),
        cmocka_unit_test(test_arrays), cmocka_unit_test(test_tangent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

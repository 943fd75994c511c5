/* SPDX-License-Identifier: Apache-2.0 */
/* Against the C library in long double. */
#include "math/elementary.h"

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

static void test_sine(void **context)
{
    (void)context;
    for (int sample = 0; sample <= SAMPLES; sample++) {
        double x = 1.5707963267948966 * sample / SAMPLES;
        assert_near(elementary_sine(x), sinl((long double)x));
        assert_near(elementary_sine(1e-6 * x), sinl((long double)(1e-6 * x)));
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
        cmocka_unit_test(test_exp),
        cmocka_unit_test(test_sine),
        cmocka_unit_test(test_tangent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

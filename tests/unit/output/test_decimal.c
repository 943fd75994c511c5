/* SPDX-License-Identifier: Apache-2.0 */
/* Numbers as text, against printf and strtod. */
#include "output/decimal.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void check(double value)
{
    char expected[DECIMAL_SIZE], text[DECIMAL_SIZE];
    (void)snprintf(expected, sizeof expected, "%.15g", value);
    if (strtod(expected, NULL) != value)
        (void)snprintf(expected, sizeof expected, "%.17g", value);
    memset(text, '?', sizeof text);
    assert_int_equal(decimal_write(text, value), strlen(expected));
    assert_string_equal(text, expected);
}

/* A value and its neighbours, with both signs. */
static void check_around(double value)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        check(sign * value);
        check(sign * nextafter(value, 0));
        check(sign * nextafter(value, INFINITY));
    }
}

static void edges_of_powers(void **state)
{
    (void)state;
    for (int exponent = -1074; exponent < 1024; exponent++)
        check_around(ldexp(1.0, exponent));
    for (int exponent = -300; exponent < 300; exponent++) {
        char text[16];
        (void)snprintf(text, sizeof text, "1e%d", exponent);
        check_around(strtod(text, NULL));
        check_around(5 * strtod(text, NULL));
    }
}

static void specials(void **state)
{
    (void)state;
    check(0.0);
    check(-0.0);
    check(INFINITY);
    check(-INFINITY);
    check((double)NAN);
    check_around(0.1);
    check_around(9.99999999999999);
    check_around(0.5 + 0x1p-49); /* a tie of the fifteenth digit */
}

/* xorshift64 */
static uint64_t next(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return *seed;
}

static void any_bits(void **state)
{
    uint64_t seed = 88172645463325252u;
    (void)state;
    for (int index = 0; index < 100000; index++) {
        const uint64_t bits = next(&seed);
        double value = 0;
        memcpy(&value, &bits, sizeof value);
        check(value);
        /* The sizes that histories hold. */
        check(ldexp((double)(bits >> 11), (int)(bits % 120) - 110));
    }
}

/* Few digits: short, or one step beside the short one. */
static void short_numbers(void **state)
{
    uint64_t seed = 1234567;
    (void)state;
    for (int index = 0; index < 20000; index++) {
        const uint64_t bits = next(&seed);
        char text[32];
        (void)snprintf(text, sizeof text, "%llue%d", (unsigned long long)(bits >> 32) % 1000000,
                       (int)(bits % 28) - 18);
        check_around(strtod(text, NULL));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_of_powers),
        cmocka_unit_test(specials),
        cmocka_unit_test(any_bits),
        cmocka_unit_test(short_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

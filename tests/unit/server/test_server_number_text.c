/* SPDX-License-Identifier: Apache-2.0 */
/* The quick way to write a number gives what the C library gives, digit for digit. */
#include "number_text.h"
#include "server_fixture.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TRIALS = 300000 };

static void expect(double value)
{
    char text[NUMBER_TEXT_SIZE], expected[NUMBER_TEXT_SIZE];
    for (int digits = 15; digits <= 17; digits++) {
        (void)snprintf(expected, sizeof expected, "%.*g", digits, value);
        if (strtod(expected, NULL) == value)
            break;
    }
    size_t length = number_text(value, text);
    if (strcmp(text, expected) != 0 || length != strlen(expected))
        fail_msg("%a is %s, not %s", value, expected, text);
}

static void test_known(void **state)
{
    static const double values[] = {0,
                                    -0.0,
                                    1,
                                    -1,
                                    10,
                                    0.1,
                                    1.0 / 3,
                                    2.0 / 3,
                                    123456789,
                                    1e14,
                                    1e15,
                                    1e16,
                                    1e17,
                                    1e22,
                                    1e23,
                                    -1e-4,
                                    1e-5,
                                    12345e-8,
                                    DBL_MIN,
                                    DBL_MAX,
                                    DBL_TRUE_MIN,
                                    0.5,
                                    9.5,
                                    999999999999999.9,
                                    0.9999999999999999,
                                    5e-324,
                                    99999999999999992.0,
                                    9007199254740993.0,
                                    4503599627370497.5,
                                    1e300,
                                    123.456};
    (void)state;
    for (size_t index = 0; index < sizeof values / sizeof values[0]; index++)
        expect(values[index]);
}

static uint64_t random_next(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return *state;
}

static void test_random(void **state)
{
    uint64_t source = 88172645463325252U;
    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        uint64_t bits = random_next(&source);
        double value;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value))
            expect(value);
        /* what has few digits, and quotients near it */
        double few = (double)(bits % 1000000) / 1000;
        expect(few);
        expect(nextafter(few, 1e9));
        expect((double)(bits >> 12) * 0x1p-50);
        expect((double)(bits % 100000) * 0x1p-20); /* ends in 5: ties */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_known), cmocka_unit_test(test_random)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "number_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIGITS_FEWEST = 15, DIGITS_MOST = 17 };

/* 0.d1 d2 d3 ... times ten to the power of `exponent`. */
struct decimal {
    bool negative;
    char digits[DIGITS_MOST + 1];
    int count, exponent;
};

/* The number with this many digits, as the C library rounds. */
static struct decimal decimal_print(double value, int count)
{
    char text[NUMBER_TEXT_SIZE];
    struct decimal decimal = {.negative = signbit(value) != 0, .count = count};
    (void)snprintf(text, sizeof text, "%.*e", count - 1, fabs(value));
    decimal.digits[0] = text[0];
    memcpy(decimal.digits + 1, text + 2, (size_t)count - 1);
    decimal.exponent = (int)strtol(text + count + 2, NULL, 10) + 1;
    return decimal;
}

/* Rounds to fewer digits. False for a tie: what was cut off before would decide it. */
static bool decimal_round(const struct decimal *from, int count, struct decimal *rounded)
{
    const char *rest = from->digits + count;
    int place = count;
    if (rest[0] == '5' && strspn(rest + 1, "0") == strlen(rest + 1))
        return false;
    *rounded = *from;
    rounded->count = count;
    rounded->digits[count] = '\0';
    if (rest[0] < '5')
        return true;
    while (place > 0 && rounded->digits[place - 1] == '9')
        rounded->digits[--place] = '0';
    if (place > 0) {
        rounded->digits[place - 1]++;
    } else {
        rounded->digits[0] = '1';
        rounded->exponent++;
    }
    return true;
}

static bool decimal_reads_back(const struct decimal *decimal, double value)
{
    int exponent = decimal->exponent - decimal->count, size = abs(exponent);
    const char end[] = {'e',
                        exponent < 0 ? '-' : '+',
                        (char)('0' + size / 100),
                        (char)('0' + size / 10 % 10),
                        (char)('0' + size % 10),
                        '\0'};
    char text[NUMBER_TEXT_SIZE];
    memcpy(text, decimal->digits, (size_t)decimal->count);
    memcpy(text + decimal->count, end, sizeof end);
    return strtod(text, NULL) == fabs(value);
}

/* As "%.*g" with the decimal's digits. */
static size_t decimal_write(const struct decimal *decimal, char text[NUMBER_TEXT_SIZE])
{
    int count = decimal->count, point = decimal->exponent;
    size_t length = 0;
    while (count > 1 && decimal->digits[count - 1] == '0')
        count--;
    if (decimal->negative)
        text[length++] = '-';
    if (point < -3 || point > decimal->count) {
        return length + (size_t)snprintf(text + length, NUMBER_TEXT_SIZE - length, "%c%s%.*se%+03d",
                                         decimal->digits[0], count > 1 ? "." : "", count - 1,
                                         decimal->digits + 1, point - 1);
    }
    if (point <= 0) {
        memcpy(text + length, "0.000", (size_t)(2 - point));
        length += (size_t)(2 - point);
    }
    for (int place = 0; place < count || place < point; place++) {
        if (place == point && place > 0)
            text[length++] = '.';
        text[length++] = '0';
        if (place < count)
            text[length - 1] = decimal->digits[place];
    }
    text[length] = '\0';
    return length;
}

size_t number_text(double value, char text[NUMBER_TEXT_SIZE])
{
    if (value == 0)
        return (size_t)snprintf(text, NUMBER_TEXT_SIZE, "%s", signbit(value) ? "-0" : "0");
    const struct decimal all = decimal_print(value, DIGITS_MOST);
    struct decimal best = all;
    for (int count = DIGITS_MOST - 1; count >= DIGITS_FEWEST; count--) {
        struct decimal fewer;
        if (!decimal_round(&all, count, &fewer))
            fewer = decimal_print(value, count);
        if (!decimal_reads_back(&fewer, value))
            break;
        best = fewer;
    }
    return decimal_write(&best, text);
}

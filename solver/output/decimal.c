/* SPDX-License-Identifier: Apache-2.0 */
#include "output/decimal.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef unsigned __int128 wide;

/* Five to this power is below 2^75: with a mantissa of 53 bits the product is exact in 128 bits. */
enum { SCALE_MAX = 32, MANTISSA_BITS = 53 };

/* A positive number times 10^scale, exactly: product / 2^shift. */
struct scaled {
    wide product, five; /* mantissa x five, five = 5^scale */
    uint64_t mantissa;
    int shift;
};

static struct scaled scale_number(double value, int scale)
{
    int exponent = 0;
    const double fraction = frexp(value, &exponent); /* value = fraction 2^exponent */
    struct scaled scaled = {.mantissa = (uint64_t)ldexp(fraction, MANTISSA_BITS), .five = 1};
    for (int index = 0; index < scale; index++)
        scaled.five *= 5;
    scaled.product = scaled.mantissa * scaled.five;
    scaled.shift = MANTISSA_BITS - exponent - scale;
    return scaled;
}

/* The nearest whole number, ties to even; below 10^18. */
static uint64_t nearest_number(const struct scaled *scaled)
{
    const int shift = scaled->shift;
    if (shift <= 0)
        return (uint64_t)(scaled->product << -shift);
    const wide whole = scaled->product >> shift;
    const wide rest = scaled->product - (whole << shift), half = (wide)1 << (shift - 1);
    return (uint64_t)whole + (rest > half || (rest == half && (whole & 1) != 0));
}

/* True if reading number x 10^-scale gives the same double: it lies within half of the distance to
 * the next one (one mantissa step is `five`; below a power of two steps are half as long), and ties
 * go to even mantissas. */
static bool brings_back(const struct scaled *scaled, uint64_t number)
{
    if (scaled->shift <= 0)
        return true; /* the number is exact */
    const wide read = (wide)number << scaled->shift;
    const bool below = read < scaled->product;
    const wide distance = below ? scaled->product - read : read - scaled->product;
    const bool power_of_two = scaled->mantissa == (uint64_t)1 << (MANTISSA_BITS - 1);
    const wide twice = below && power_of_two ? 4 * distance : 2 * distance;
    return twice < scaled->five || (twice == scaled->five && (scaled->mantissa & 1) == 0);
}

/* `digits` (its first one not zero) x 10^(first - count + 1) in the style of %g. */
static size_t print_digits(char *text, const char *digits, int count, int first, int precision)
{
    char *next = text;
    while (count > 1 && digits[count - 1] == '0')
        count--;
    if (first < -4 || first >= precision) {
        *next++ = digits[0];
        if (count > 1) {
            *next++ = '.';
            memcpy(next, digits + 1, (size_t)count - 1);
            next += count - 1;
        }
        next += snprintf(next, 8, "e%c%02d", first < 0 ? '-' : '+', abs(first));
        return (size_t)(next - text);
    }
    if (first < 0) {
        memcpy(next, "0.000", 5);
        next += 1 - first;
    }
    for (int index = 0; index < count || index <= first; index++) {
        if (index == first + 1 && first >= 0)
            *next++ = '.';
        *next++ = index < count ? digits[index] : '0';
    }
    *next = '\0';
    return (size_t)(next - text);
}

static int count_digits(uint64_t number)
{
    int count = 1;
    for (uint64_t limit = 10; count < 19 && number >= limit; limit *= 10)
        count++;
    return count;
}

static void split_digits(uint64_t number, int count, char *digits)
{
    for (int index = count; index-- > 0; number /= 10)
        digits[index] = (char)('0' + number % 10);
}

/* A positive number with so many significant digits: the digits as a whole number, and in *first
 * the decimal exponent of the first one, which is guessed right but for one. 0: out of range. */
static uint64_t significant(double value, int precision, int *first, struct scaled *scaled)
{
    for (int attempt = 0; attempt < 3; attempt++) {
        const int scale = precision - 1 - *first;
        if (scale < 0 || scale > SCALE_MAX)
            return 0;
        *scaled = scale_number(value, scale);
        const uint64_t number = nearest_number(scaled);
        const int count = count_digits(number);
        if (count == precision)
            return number;
        *first += count > precision ? 1 : -1;
    }
    return 0;
}

static size_t print_slowly(char text[DECIMAL_SIZE], double value)
{
    int length = snprintf(text, DECIMAL_SIZE, "%.15g", value);
    if (strtod(text, NULL) != value)
        length = snprintf(text, DECIMAL_SIZE, "%.17g", value);
    return (size_t)length;
}

size_t decimal_write(char text[DECIMAL_SIZE], double value)
{
    const double size = fabs(value);
    struct scaled scaled;
    char digits[20], *start = text;
    if (value == 0 && !signbit(value)) {
        memcpy(text, "0", 2);
        return 1;
    }
    /* Where 17 digits take a scale of 0 to SCALE_MAX. */
    if (!(size >= 1e-15 && size < 1e14))
        return print_slowly(text, value);
    int first = (int)floor(log10(size)), precision = 15;
    uint64_t number = significant(size, precision, &first, &scaled);
    if (number != 0 && !brings_back(&scaled, number)) {
        precision = 17;
        number = significant(size, precision, &first, &scaled);
    }
    if (number == 0)
        return print_slowly(text, value);
    split_digits(number, precision, digits);
    if (value < 0)
        *start++ = '-';
    return (size_t)(start - text) + print_digits(start, digits, precision, first, precision);
}

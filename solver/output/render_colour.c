/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_colour.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAP_TERMS = 7 };

/* Least-squares polynomials of the published table of viridis (CC0), constant term first; the
 * largest error is 0.01 of a channel. */
static double map_channel(const double coefficients[MAP_TERMS], double position)
{
    double sum = 0.0;
    for (int term = MAP_TERMS - 1; term >= 0; term--)
        sum = sum * position + coefficients[term];
    return fmin(fmax(sum, 0.0), 1.0);
}

struct colour colour_from_map(double position)
{
    static const double red[MAP_TERMS] = {0.2777273272, 0.1050930431, -0.3308618287, -4.634230499,
                                          6.228269936,  4.776384998,  -5.435455856};
    static const double green[MAP_TERMS] = {0.0054073445, 1.404613530,  0.2148475595, -5.799100973,
                                            14.17993337,  -13.74514538, 4.645852612};
    static const double blue[MAP_TERMS] = {0.3340998053, 1.384590163,  0.0950951630, -19.33244096,
                                           56.69055260,  -65.35303263, 26.31243525};
    if (isnan(position))
        return (struct colour){0.6, 0.6, 0.6};
    return (struct colour){map_channel(red, position), map_channel(green, position),
                           map_channel(blue, position)};
}

static int compare_doubles(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* An end that lies beyond the middle 98 % by more than half of their range is cut there. */
static void cut_outliers(struct colour_range *range, const double *sorted, size_t count)
{
    const double low = sorted[count / 100], high = sorted[count - 1 - count / 100];
    const double span = high - low;
    range->low = range->minimum;
    range->high = range->maximum;
    if (span <= 0.0) /* all but a few are equal, and the few are what there is to see */
        return;
    range->low = low - range->minimum > 0.5 * span ? low : range->minimum;
    range->high = range->maximum - high > 0.5 * span ? high : range->maximum;
}

enum talus_status colour_range_find(const double *values, size_t count, struct colour_range *range,
                                    struct talus_error *error)
{
    *range = (struct colour_range){.high = 1.0};
    double *sorted = malloc((count + 1) * sizeof *sorted);
    if (sorted == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a picture");
    size_t finite_count = 0;
    for (size_t index = 0; index < count; index++) {
        if (isfinite(values[index]))
            sorted[finite_count++] = values[index];
    }
    if (finite_count > 0) {
        qsort(sorted, finite_count, sizeof *sorted, compare_doubles);
        range->minimum = sorted[0];
        range->maximum = sorted[finite_count - 1];
        cut_outliers(range, sorted, finite_count);
    }
    free(sorted);
    const double size = fmax(fabs(range->low), fabs(range->high));
    if (!(range->high - range->low > 1e-9 * size)) { /* one value: a bar around it */
        const double margin = size > 0.0 ? 0.5 * size : 0.5;
        range->low -= margin;
        range->high += margin;
    }
    return TALUS_OK;
}

double colour_range_position(const struct colour_range *range, double value)
{
    if (isnan(value))
        return value;
    return fmin(fmax((value - range->low) / (range->high - range->low), 0.0), 1.0);
}

struct ticks ticks_find(double low, double high, int wanted)
{
    const double rough = (high - low) / wanted;
    const double power = pow(10.0, floor(log10(rough)));
    const double digit = rough / power;
    const double step = power * (digit < 1.5 ? 1.0 : digit < 3.5 ? 2.0 : digit < 7.5 ? 5.0 : 10.0);
    /* The tolerance keeps ends that are ticks but for round-off. */
    return (struct ticks){.step = step,
                          .first = lrint(ceil(low / step - 1e-6)),
                          .last = lrint(floor(high / step + 1e-6))};
}

void ticks_format(const struct ticks *ticks, long index, char *text, size_t size)
{
    const double value = (double)index * ticks->step;
    const double largest =
        ticks->step *
        (double)(labs(ticks->first) > labs(ticks->last) ? labs(ticks->first) : labs(ticks->last));
    if (largest >= 1e5 || largest < 1e-3) {
        const double digits = floor(log10(largest) + 1e-9) - floor(log10(ticks->step) + 1e-9);
        (void)snprintf(text, size, "%.*e", (int)fmax(digits, 0.0), value);
        return;
    }
    const int decimals = (int)fmax(-floor(log10(ticks->step) + 1e-9), 0.0);
    (void)snprintf(text, size, "%.*f", decimals, value);
}

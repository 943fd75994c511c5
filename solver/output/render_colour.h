/* SPDX-License-Identifier: Apache-2.0 */
/* From values to colours and from ranges to tick marks. */
#ifndef TALUS_RENDER_COLOUR_H
#define TALUS_RENDER_COLOUR_H

#include "output/render_raster.h"
#include "talus/status.h"

#include <stddef.h>

/* The viridis map of S. van der Walt and N. Smith: perceptually uniform, readable in grey and by
 * the colour-blind. position 0..1; NAN gives grey. */
struct colour colour_from_map(double position);

struct colour_range {
    double low, high;        /* ends of the colour bar, low < high */
    double minimum, maximum; /* of the finite values */
};

/* The range of a colour bar for values[count]: all of them, unless less than 1 % at either end
 * would take more than a third of the bar for themselves. TALUS_MEMORY. */
TALUS_MUST_CHECK enum talus_status colour_range_find(const double *values, size_t count,
                                                     struct colour_range *range,
                                                     struct talus_error *error);

/* Position of a value on the bar, 0..1 (clamped); NAN stays. */
double colour_range_position(const struct colour_range *range, double value);

/* Round tick marks inside [low, high], about `wanted` of them: the multiples first..last of step.
 */
struct ticks {
    double step;
    long first, last;
};
struct ticks ticks_find(double low, double high, int wanted);

/* Formats a tick's value with as many digits as its step needs. */
void ticks_format(const struct ticks *ticks, long index, char *text, size_t size);

#endif

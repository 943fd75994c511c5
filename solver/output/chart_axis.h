/* SPDX-License-Identifier: Apache-2.0 */
/* Axes of a chart: from values to pixels, tick marks, and the frame around a plot. Private to
 * chart*.c. */
#ifndef TALUS_CHART_AXIS_H
#define TALUS_CHART_AXIS_H

#include "output/chart_data.h"
#include "output/render_view.h"

/* A range of values, on a linear or logarithmic scale. */
struct chart_scale {
    bool logarithmic;
    double low, high; /* values; low < high, positive on a logarithmic scale */
};

/* Grows a range that starts as {.low = INFINITY, .high = -INFINITY}. */
void chart_scale_add(struct chart_scale *scale, double value);
/* Makes a range of whatever was added, with a margin (share of its length) at both ends. */
void chart_scale_finish(struct chart_scale *scale, double margin);
/* The range of a chart's points along one of its axes. */
struct chart_scale chart_find_scale(const struct chart *chart, bool along_x, double margin);
/* Place of a value as a share of the range. */
double chart_scale_share(const struct chart_scale *scale, double value);

enum { CHART_TICK_MAX = 128 };

struct chart_tick {
    double value;
    bool named;   /* else a short mark without a number */
    int exponent; /* of 10, where `text` is empty */
    char text[32];
};

/* Tick marks inside a range, `wanted` of them with numbers at most, or nearly; returns how many. */
size_t chart_ticks(const struct chart_scale *scale, int wanted,
                   struct chart_tick ticks[CHART_TICK_MAX]);

/* A plot with its axes. */
struct chart_frame {
    struct rectangle plot; /* [pixels] */
    double font;
    const struct chart_quantity *x, *y;
    struct chart_scale x_scale, y_scale;
};

double chart_frame_x(const struct chart_frame *frame, double value);
double chart_frame_y(const struct chart_frame *frame, double value);

/* The grid behind the data, and the axes with numbers and names around it. */
void chart_frame_grid(const struct chart_frame *frame, cairo_t *context);
void chart_frame_axes(const struct chart_frame *frame, cairo_t *context);

/* The room that the numbers at the left of a plot need [pixels]. */
double chart_frame_left(const struct chart_frame *frame, cairo_t *context);

/* Marks and numbers at the right side of a colour bar with a logarithmic scale. */
void chart_bar_decades(cairo_t *context, double font, const struct rectangle *bar,
                       const struct chart_scale *scale);

/* How many bytes of a text, at most `most`, are whole letters: half of one is no UTF-8. */
int chart_text_length(const char *text, int most);

/* The unit with its prefix, empty without one; and "name [unit]". */
void chart_quantity_unit(const struct chart_quantity *quantity, char *text, size_t size);
void chart_quantity_label(const struct chart_quantity *quantity, char *text, size_t size);

/* Text that is made smaller, then cut, to be no longer than `room`. The font must be set. */
void chart_text_fitted(cairo_t *context, double x, double y, double share_x, double share_y,
                       double room, double size, const char *text);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* What the kinds of charts share: colours and markers of series, the legend, title and note, and
 * where they stand. Private to chart*.c. */
#ifndef TALUS_CHART_PLACE_H
#define TALUS_CHART_PLACE_H

#include "output/chart_axis.h"
#include "output/render_colour.h"

/* How a series is drawn: its own colour, and beyond colour a marker and dashes. */
struct chart_style {
    struct colour colour;
    int marker, dashes;
};

/* The style of one of `count`; `ordered`: the values are numbers, so that their colours go from
 * dark to light, else as different as they can be (Okabe and Ito 2008, for the colour-blind too).
 */
struct chart_style chart_style_find(size_t index, size_t count, bool ordered);

void chart_style_line(cairo_t *context, const struct chart_style *style, double font);
void chart_marker(cairo_t *context, const struct chart_style *style, double x, double y,
                  double radius);

/* A legend of words, one below the other from (left, top), in no more than the given room; what
 * does not fit is counted. With `front` a last entry for the Pareto front. */
struct chart_legend {
    const char *title; /* "" without one */
    const struct chart_words *words;
    double font, width, height;
    bool lines, front; /* `lines`: entries show their line too */
};
/* The width that it would like to have. */
double chart_legend_width(const struct chart_legend *legend, cairo_t *context);
void chart_legend_draw(const struct chart_legend *legend, cairo_t *context, double left,
                       double top);

double chart_font(const struct chart *chart);
/* White ground and the title at the top. */
void chart_begin(const struct chart *chart, cairo_t *context, double height);
/* The note at the bottom: how many rows are not drawn and why. Nothing if all are. */
void chart_note(const struct chart *chart, cairo_t *context, double height);
bool chart_has_note(const struct chart *chart);

/* What chart_svg does, in steps: reading (NULL with the error; the specification must outlive the
 * chart), and drawing on any surface at least as large as the chart says [pixels]. */
struct chart *chart_create(const json_t *specification, struct talus_error *error);
void chart_destroy(struct chart *chart);
void chart_measure(const struct chart *chart, double *width, double *height);
void chart_draw(const struct chart *chart, cairo_t *context);

/* The Pareto front of points (x is a cost, y an error): moves those that no other beats in both to
 * the beginning, by cost, and returns how many. */
size_t chart_front(struct chart_point *points, size_t count);

/* Draws the points of a chart as lines in an area that includes axes and, if wanted, a legend. */
void chart_panel_lines(const struct chart *chart, struct rectangle area, double font, bool legend,
                       cairo_t *context);
/* Draws contours and their cuts, a row for each series, in an area. */
void chart_panel_contours(const struct chart *chart, struct rectangle area, double font,
                          cairo_t *context);

#endif

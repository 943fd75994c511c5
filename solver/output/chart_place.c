/* SPDX-License-Identifier: Apache-2.0 */
#include "output/chart_place.h"

#include "output/render_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MARKER_KINDS = 6 };

struct chart_style chart_style_find(size_t index, size_t count, bool ordered)
{
    static const struct colour palette[] = {
        {0.000, 0.447, 0.698}, {0.835, 0.369, 0.000}, {0.000, 0.620, 0.451}, {0.800, 0.475, 0.655},
        {0.337, 0.706, 0.914}, {0.902, 0.624, 0.000}, {0.350, 0.350, 0.350},
    };
    enum { PALETTE = sizeof palette / sizeof palette[0] };
    struct chart_style style = {.colour = palette[index % PALETTE],
                                .marker = (int)(index % MARKER_KINDS),
                                .dashes = (int)(index / PALETTE % 4)};
    if (ordered && count > 2) { /* the lightest end of the map is too light for lines */
        style.colour = colour_from_map(0.88 * (double)index / (double)(count - 1));
        style.dashes = 0;
    }
    return style;
}

void chart_style_line(cairo_t *context, const struct chart_style *style, double font)
{
    static const double dashes[4][4] = {{1, 0}, {5, 3}, {1, 2}, {6, 2}};
    static const int counts[4] = {0, 2, 2, 2};
    double scaled[4];
    for (int index = 0; index < 4; index++)
        scaled[index] = dashes[style->dashes][index] * font / 6.0;
    cairo_set_dash(context, scaled, counts[style->dashes], 0.0);
    cairo_set_line_width(context, font / 7.0);
    cairo_set_source_rgb(context, style->colour.red, style->colour.green, style->colour.blue);
}

void chart_marker(cairo_t *context, const struct chart_style *style, double x, double y,
                  double radius)
{
    /* Corners of polygons of about the area of the disc, as x, y in radii. */
    static const double corners[MARKER_KINDS][4][2] = {
        {{0, 0}, {0, 0}, {0, 0}, {0, 0}},
        {{-0.88, -0.88}, {0.88, -0.88}, {0.88, 0.88}, {-0.88, 0.88}},
        {{0, -1.3}, {1.15, 0.75}, {-1.15, 0.75}, {0, -1.3}},
        {{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}},
        {{0, 1.3}, {1.15, -0.75}, {-1.15, -0.75}, {0, 1.3}},
        {{-1.3, -0.5}, {1.3, -0.5}, {1.3, 0.5}, {-1.3, 0.5}},
    };
    const double(*shape)[2] = corners[style->marker];
    cairo_new_path(context);
    if (style->marker == 0)
        cairo_arc(context, x, y, radius, 0.0, 2.0 * M_PI);
    for (int corner = 0; style->marker != 0 && corner < 4; corner++)
        cairo_line_to(context, x + radius * shape[corner][0], y + radius * shape[corner][1]);
    cairo_close_path(context);
    cairo_set_source_rgb(context, style->colour.red, style->colour.green, style->colour.blue);
    cairo_fill_preserve(context);
    cairo_set_dash(context, NULL, 0, 0.0);
    cairo_set_source_rgb(context, 1.0, 1.0, 1.0);
    cairo_set_line_width(context, 0.22 * radius);
    cairo_stroke(context);
}

static const char front_text[] = "Pareto front";

double chart_legend_width(const struct chart_legend *legend, cairo_t *context)
{
    cairo_text_extents_t extents;
    double widest = 0.0;
    render_text_style(context, legend->font, true);
    cairo_text_extents(context, legend->title, &extents);
    widest = extents.x_advance - 2.4 * legend->font;
    render_text_style(context, 0.95 * legend->font, false);
    for (size_t index = 0; index < legend->words->count; index++) {
        cairo_text_extents(context, legend->words->items[index].text, &extents);
        widest = fmax(widest, extents.x_advance);
    }
    cairo_text_extents(context, front_text, &extents);
    if (legend->front)
        widest = fmax(widest, extents.x_advance);
    return widest + 3.2 * legend->font;
}

static void legend_entry(const struct chart_legend *legend, cairo_t *context, double left, double y,
                         size_t index)
{
    const double font = legend->font;
    const struct chart_style style =
        chart_style_find(index, legend->words->count, legend->words->numeric);
    if (legend->lines) {
        chart_style_line(context, &style, font);
        cairo_move_to(context, left, y);
        cairo_rel_line_to(context, 2.0 * font, 0.0);
        cairo_stroke(context);
    }
    chart_marker(context, &style, left + font, y, 0.33 * font);
    render_text_style(context, 0.95 * font, false);
    chart_text_fitted(context, left + 2.5 * font, y, 0.0, 0.5, legend->width - 2.5 * font,
                      0.95 * font, legend->words->items[index].text);
}

static void legend_front(const struct chart_legend *legend, cairo_t *context, double left, double y)
{
    cairo_set_source_rgba(context, 0.15, 0.16, 0.18, 0.25);
    cairo_set_dash(context, NULL, 0, 0.0);
    cairo_set_line_width(context, 0.6 * legend->font);
    cairo_move_to(context, left, y);
    cairo_rel_line_to(context, 2.0 * legend->font, 0.0);
    cairo_stroke(context);
    render_text_style(context, 0.95 * legend->font, false);
    render_text(context, left + 2.5 * legend->font, y, 0.0, 0.5, front_text);
}

void chart_legend_draw(const struct chart_legend *legend, cairo_t *context, double left, double top)
{
    const double step = 1.6 * legend->font, bottom = top + legend->height;
    double y = top + 0.6 * legend->font;
    size_t index = 0;
    if (legend->title[0] != '\0') {
        render_text_style(context, legend->font, true);
        chart_text_fitted(context, left, y, 0.0, 0.5, legend->width, legend->font, legend->title);
        y += step;
    }
    if (legend->front) {
        legend_front(legend, context, left, y);
        y += step;
    }
    for (; index < legend->words->count; index++) {
        if (y + step > bottom && index + 1 < legend->words->count)
            break;
        legend_entry(legend, context, left, y, index);
        y += step;
    }
    if (index < legend->words->count) {
        char text[48];
        (void)snprintf(text, sizeof text, "and %zu more", legend->words->count - index);
        render_text_style(context, 0.95 * legend->font, false);
        render_text(context, left, y, 0.0, 0.5, text);
    }
}

double chart_font(const struct chart *chart)
{
    return fmax(9.0, chart->width / (chart->kind == CHART_CONTOURS ? 85.0 : 72.0));
}

void chart_begin(const struct chart *chart, cairo_t *context, double height)
{
    const double font = chart_font(chart);
    cairo_set_source_rgb(context, 1.0, 1.0, 1.0);
    cairo_rectangle(context, 0.0, 0.0, chart->width, height);
    cairo_fill(context);
    render_text_style(context, 1.25 * font, true);
    chart_text_fitted(context, 1.2 * font, 1.9 * font, 0.0, 1.0, chart->width - 2.4 * font,
                      1.25 * font, chart->title);
}

bool chart_has_note(const struct chart *chart)
{
    return chart->count < chart->row_count || chart->row_count == 0;
}

void chart_note(const struct chart *chart, cairo_t *context, double height)
{
    const struct {
        size_t count;
        const char *what;
    } parts[] = {{chart->unfinished, "not finished"},
                 {chart->failed, "failed or cancelled"},
                 {chart->missing, "without a value"},
                 {chart->not_positive, "not positive on a logarithmic axis"}};
    const double font = chart_font(chart);
    char text[300];
    if (!chart_has_note(chart))
        return;
    int length =
        snprintf(text, sizeof text, "%zu of %zu rows drawn", chart->count, chart->row_count);
    for (size_t index = 0; index < sizeof parts / sizeof parts[0]; index++) {
        if (parts[index].count > 0)
            length += snprintf(text + length, sizeof text - (size_t)length, "%s%zu %s",
                               length > 0 && strchr(text, ':') == NULL ? ": " : ", ",
                               parts[index].count, parts[index].what);
    }
    render_text_style(context, 0.85 * font, false);
    cairo_set_source_rgb(context, 0.4, 0.41, 0.43);
    chart_text_fitted(context, chart->width - 1.2 * font, height - 0.6 * font, 1.0, 1.0,
                      chart->width - 2.4 * font, 0.85 * font, text);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Contours over two parameters beside their cuts along both, one row for each series: the form of
 * Mast 2013, figures 7.36 to 7.45. */
#include "output/chart_mesh.h"
#include "output/chart_place.h"
#include "output/render_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BAND_COUNT = 10 };

/* Bands between round levels; z as in the mesh. */
struct bands {
    struct ticks levels; /* the ends of bands: first to last */
    size_t points;       /* that the series has */
    const struct chart_point *highest;
};

static double mesh_z(const struct chart *chart, double z)
{
    return chart->z.logarithmic ? log10(z) : z;
}

static struct bands find_bands(const struct chart *chart, size_t series)
{
    struct chart_scale scale = {.low = INFINITY, .high = -INFINITY};
    struct bands bands = {.points = 0};
    for (size_t index = 0; index < chart->count; index++) {
        const struct chart_point *point = &chart->points[index];
        if (point->series != series)
            continue;
        chart_scale_add(&scale, mesh_z(chart, point->z));
        bands.points++;
        if (bands.highest == NULL || point->z > bands.highest->z)
            bands.highest = point;
    }
    chart_scale_finish(&scale, 0.0);
    bands.levels = ticks_find(scale.low, scale.high, BAND_COUNT);
    bands.levels.first = lrint(floor(scale.low / bands.levels.step + 1e-6));
    bands.levels.last = lrint(ceil(scale.high / bands.levels.step - 1e-6));
    return bands;
}

static void set_band_colour(cairo_t *context, const struct bands *bands, long band)
{
    const double count = (double)(bands->levels.last - bands->levels.first);
    const struct colour colour =
        colour_from_map(((double)(band - bands->levels.first) + 0.5) / count);
    cairo_set_source_rgb(context, colour.red, colour.green, colour.blue);
}

static void draw_bar(const struct chart *chart, const struct bands *bands, struct rectangle bar,
                     double font, cairo_t *context)
{
    const double count = (double)(bands->levels.last - bands->levels.first);
    const double low = (double)bands->levels.first * bands->levels.step;
    const double high = (double)bands->levels.last * bands->levels.step;
    char label[1100];
    for (long band = bands->levels.first; band < bands->levels.last; band++) {
        const double above = (double)(bands->levels.last - 1 - band);
        set_band_colour(context, bands, band);
        cairo_rectangle(context, bar.left, bar.top + bar.height * above / count, bar.width,
                        bar.height / count);
        cairo_fill(context);
    }
    render_text_style(context, 0.85 * font, false);
    cairo_set_dash(context, NULL, 0, 0.0);
    cairo_set_line_width(context, fmax(1.0, font / 14.0));
    if (chart->z.logarithmic)
        chart_bar_decades(context, font, &bar,
                          &(struct chart_scale){true, pow(10.0, low), pow(10.0, high)});
    else
        render_bar_ticks(context, font, &bar, low, high);
    chart_quantity_label(&chart->z, label, sizeof label);
    render_text_style(context, 0.9 * font, false);
    cairo_save(context);
    cairo_translate(context, bar.left + bar.width + 4.9 * font, bar.top + 0.5 * bar.height);
    cairo_rotate(context, -M_PI / 2.0);
    chart_text_fitted(context, 0.0, 0.0, 0.5, 0.5, bar.height + 4.0 * font, 0.9 * font, label);
    cairo_restore(context);
}

static void fill_bands(const struct chart_mesh *mesh, const struct chart_frame *frame,
                       const struct bands *bands, cairo_t *context)
{
    for (long band = bands->levels.first; band < bands->levels.last; band++) {
        const double level =
            band == bands->levels.first ? -INFINITY : (double)band * bands->levels.step;
        cairo_new_path(context);
        /* Two bands beneath each other, so that no white shines through where they meet. */
        chart_mesh_above(mesh, frame, level, (double)(band + 2) * bands->levels.step, context);
        set_band_colour(context, bands, band);
        cairo_fill(context);
    }
    cairo_set_dash(context, NULL, 0, 0.0);
    cairo_set_line_width(context, frame->font / 16.0);
    cairo_set_source_rgba(context, 1.0, 1.0, 1.0, 0.75);
    for (long band = bands->levels.first + 1; band < bands->levels.last; band++) {
        cairo_new_path(context);
        chart_mesh_line(mesh, frame, (double)band * bands->levels.step, context);
        cairo_stroke(context);
    }
}

/* Each run as a dot: with its own colour where there are no contours. */
static void draw_runs(const struct chart *chart, const struct chart_frame *frame, size_t series,
                      const struct bands *bands, bool coloured, cairo_t *context)
{
    const double count = (double)(bands->levels.last - bands->levels.first);
    for (size_t index = 0; index < chart->count; index++) {
        const struct chart_point *point = &chart->points[index];
        struct chart_style style = {.colour = {0.1, 0.1, 0.1}};
        if (point->series != series)
            continue;
        if (coloured)
            style.colour = colour_from_map(
                (mesh_z(chart, point->z) / bands->levels.step - (double)bands->levels.first) /
                count);
        chart_marker(context, &style, chart_frame_x(frame, point->x),
                     chart_frame_y(frame, point->y), (coloured ? 0.45 : 0.22) * frame->font);
    }
}

static void draw_map(const struct chart *chart, size_t series, struct rectangle area, double font,
                     cairo_t *context)
{
    const double bar_room = 8.0 * font;
    const struct bands bands = find_bands(chart, series);
    struct chart_frame frame = {.plot = {.top = area.top, .height = area.height - 4.2 * font},
                                .font = font,
                                .x = &chart->x,
                                .y = &chart->y,
                                .x_scale = chart_find_scale(chart, true, 0.03),
                                .y_scale = chart_find_scale(chart, false, 0.03)};
    struct chart_mesh mesh;
    const double left = chart_frame_left(&frame, context);
    frame.plot.left = area.left + left;
    frame.plot.width = area.width - left - bar_room;
    chart_frame_grid(&frame, context);
    const bool good = chart_mesh_init(&mesh, chart, series, &frame);
    if (good && bands.points > 0) {
        fill_bands(&mesh, &frame, &bands, context);
        draw_runs(chart, &frame, series, &bands, mesh.triangle_count == 0, context);
        draw_bar(chart, &bands,
                 (struct rectangle){frame.plot.left + frame.plot.width + 1.2 * font, area.top, font,
                                    frame.plot.height},
                 font, context);
    }
    chart_mesh_release(&mesh);
    chart_frame_axes(&frame, context);
}

static size_t word_of(const struct chart_words *words, double value)
{
    size_t nearest = 0;
    for (size_t index = 1; index < words->count; index++) {
        if (fabs(words->items[index].number - value) < fabs(words->items[nearest].number - value))
            nearest = index;
    }
    return nearest;
}

/* z along one parameter, a line for each value of the other: a chart of its own. */
static void draw_cut(const struct chart *chart, size_t series, bool along_x, struct rectangle area,
                     double font, cairo_t *context)
{
    const struct chart_quantity *split = along_x ? &chart->y : &chart->x;
    struct chart cut = {.kind = CHART_LINES,
                        .joined = true,
                        .title = "",
                        .width = chart->width,
                        .x = along_x ? chart->x : chart->y,
                        .y = chart->z,
                        .series = *split,
                        .series_count = split->words.count,
                        .points = malloc((chart->count + 1) * sizeof *cut.points)};
    if (cut.points == NULL) {
        render_text(context, area.left, area.top, 0.0, 0.0, "out of memory");
        return;
    }
    for (size_t index = 0; index < chart->count; index++) {
        const struct chart_point *point = &chart->points[index];
        if (point->series == series)
            cut.points[cut.count++] = (struct chart_point){
                .x = along_x ? point->x : point->y,
                .y = point->z,
                .series = word_of(&split->words, along_x ? point->y : point->x),
                .row = point->row};
    }
    chart_panel_lines(&cut, area, font, true, context);
    free(cut.points);
}

/* What a row is of, and its largest value. */
static void draw_heading(const struct chart *chart, size_t series, struct rectangle area,
                         double font, cairo_t *context)
{
    const struct bands bands = find_bands(chart, series);
    const struct chart_words *words = &chart->series.words;
    const char *x = chart->x.name, *y = chart->y.name, *split = chart->series.name;
    char text[2000] = "", unit[540];
    int length = 0;
    chart_quantity_unit(&chart->z, unit, sizeof unit);
    if (words->count > 0) {
        const char *value = words->items[series].text;
        length = snprintf(text, sizeof text, "%.*s = %.*s:  ", chart_text_length(split, 300), split,
                          chart_text_length(value, 300), value);
    }
    if (length < 0)
        return;
    if (bands.highest == NULL)
        (void)snprintf(text + length, sizeof text - (size_t)length, "no results yet");
    else
        (void)snprintf(text + length, sizeof text - (size_t)length,
                       "largest %.4g%s%s, at %.*s %.4g and %.*s %.4g", bands.highest->z,
                       unit[0] == '\0' ? "" : " ", unit, chart_text_length(x, 200), x,
                       bands.highest->x, chart_text_length(y, 200), y, bands.highest->y);
    render_text_style(context, font, words->count > 0);
    chart_text_fitted(context, area.left, area.top, 0.0, 0.0, area.width, font, text);
}

void chart_panel_contours(const struct chart *chart, struct rectangle area, double font,
                          cairo_t *context)
{
    const size_t rows = chart_contour_rows(chart);
    const double height = area.height / (double)rows, heading = 2.0 * font;
    for (size_t row = 0; row < rows; row++) {
        const double top = area.top + (double)row * height;
        struct rectangle part = {area.left, top + heading,
                                 (chart->gridded ? 0.40 : 0.80) * area.width,
                                 height - heading - 0.8 * font};
        draw_heading(chart, row, (struct rectangle){area.left, top, area.width, heading}, font,
                     context);
        draw_map(chart, row, part, font, context);
        if (!chart->gridded)
            continue;
        part.left = area.left + 0.41 * area.width;
        part.width = 0.295 * area.width;
        draw_cut(chart, row, true, part, font, context);
        part.left = area.left + 0.705 * area.width;
        draw_cut(chart, row, false, part, font, context);
    }
}

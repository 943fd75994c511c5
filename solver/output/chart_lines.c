/* SPDX-License-Identifier: Apache-2.0 */
#include "output/chart_place.h"
#include "output/render_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* By series, then along x (or, of work against precision, in the order of the rows). */
static int compare_along(const void *left, const void *right)
{
    const struct chart_point *a = left, *b = right;
    if (a->series != b->series)
        return a->series < b->series ? -1 : 1;
    if (a->x < b->x || a->x > b->x)
        return a->x < b->x ? -1 : 1;
    return (a->row > b->row) - (a->row < b->row);
}

static int compare_rows(const void *left, const void *right)
{
    const struct chart_point *a = left, *b = right;
    if (a->series != b->series)
        return a->series < b->series ? -1 : 1;
    return (a->row > b->row) - (a->row < b->row);
}

/* The points of a chart in the order in which lines go through them; owned by the caller. */
static struct chart_point *sort_points(const struct chart *chart)
{
    struct chart_point *sorted = malloc((chart->count + 1) * sizeof *sorted);
    if (sorted == NULL)
        return NULL;
    for (size_t index = 0; index < chart->count; index++)
        sorted[index] = chart->points[index];
    qsort(sorted, chart->count, sizeof *sorted,
          chart->kind == CHART_WORK_PRECISION ? compare_rows : compare_along);
    return sorted;
}

/* A line through the points of a series; where several share an x, through their mean. */
static void draw_line(const struct chart *chart, const struct chart_frame *frame, cairo_t *context,
                      const struct chart_point *points, size_t count)
{
    const bool averaged = chart->kind != CHART_WORK_PRECISION;
    const struct chart_style style =
        chart_style_find(points->series, chart->series_count, chart->series.words.numeric);
    chart_style_line(context, &style, frame->font);
    cairo_new_path(context);
    for (size_t index = 0; index < count;) {
        double sum = points[index].y;
        size_t same = 1;
        while (averaged && index + same < count && points[index + same].x <= points[index].x)
            sum += points[index + same++].y;
        cairo_line_to(context, chart_frame_x(frame, points[index].x),
                      chart_frame_y(frame, sum / (double)same));
        index += same;
    }
    cairo_stroke(context);
}

static bool is_joined(const struct chart *chart)
{
    return chart->kind == CHART_WORK_PRECISION ||
           (chart->joined && chart->x.is_parameter && !chart_is_worded(&chart->x));
}

static void draw_points(const struct chart *chart, const struct chart_frame *frame,
                        cairo_t *context, const struct chart_point *points)
{
    const double radius = (chart->count > 400 ? 0.2 : 0.33) * frame->font;
    for (size_t first = 0, behind; is_joined(chart) && first < chart->count; first = behind) {
        behind = first;
        while (behind < chart->count && points[behind].series == points[first].series)
            behind++;
        draw_line(chart, frame, context, points + first, behind - first);
    }
    for (size_t index = 0; index < chart->count; index++) {
        const struct chart_style style = chart_style_find(points[index].series, chart->series_count,
                                                          chart->series.words.numeric);
        chart_marker(context, &style, chart_frame_x(frame, points[index].x),
                     chart_frame_y(frame, points[index].y), radius);
    }
}

static int compare_cost(const void *left, const void *right)
{
    const struct chart_point *a = left, *b = right;
    if (a->x < b->x || a->x > b->x)
        return a->x < b->x ? -1 : 1;
    return (a->y > b->y) - (a->y < b->y);
}

size_t chart_front(struct chart_point *points, size_t count)
{
    size_t kept = 0;
    qsort(points, count, sizeof *points, compare_cost);
    for (size_t index = 0; index < count; index++) {
        if (kept == 0 || points[index].y < points[kept - 1].y)
            points[kept++] = points[index];
    }
    return kept;
}

/* The broad line below the points of the front. */
static void draw_front(const struct chart *chart, const struct chart_frame *frame, cairo_t *context,
                       const struct chart_point *points)
{
    struct chart_point *front = malloc((chart->count + 1) * sizeof *front);
    if (front == NULL)
        return;
    memcpy(front, points, chart->count * sizeof *front);
    const size_t count = chart_front(front, chart->count);
    cairo_new_path(context);
    for (size_t index = 0; index < count; index++) {
        cairo_line_to(context, chart_frame_x(frame, front[index].x),
                      chart_frame_y(frame, front[index].y));
        cairo_rel_line_to(context, 0.0, 0.0); /* a front of one point is a dot */
    }
    free(front);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_dash(context, NULL, 0, 0.0);
    cairo_set_line_width(context, 1.1 * frame->font);
    cairo_set_source_rgba(context, 0.15, 0.16, 0.18, 0.18);
    cairo_stroke(context);
    cairo_set_line_cap(context, CAIRO_LINE_CAP_BUTT);
}

static void draw_empty(const struct chart *chart, const struct chart_frame *frame, cairo_t *context)
{
    const bool ended = chart->row_count > 0 && chart->unfinished == 0;
    render_text_style(context, 1.1 * frame->font, false);
    cairo_set_source_rgb(context, 0.4, 0.41, 0.43);
    render_text(context, frame->plot.left + 0.5 * frame->plot.width,
                frame->plot.top + 0.5 * frame->plot.height, 0.5, 0.5,
                ended ? "nothing to draw" : "no results yet");
}

void chart_panel_lines(const struct chart *chart, struct rectangle area, double font, bool legend,
                       cairo_t *context)
{
    struct chart_legend own = {.title = chart->series.name == NULL ? "" : chart->series.name,
                               .words = &chart->series.words,
                               .font = font,
                               .height = area.height - 4.0 * font,
                               .lines = is_joined(chart),
                               .front = chart->kind == CHART_WORK_PRECISION && chart->count > 0};
    struct chart_frame frame = {.plot = {.top = area.top, .height = area.height - 4.2 * font},
                                .font = font,
                                .x = &chart->x,
                                .y = &chart->y,
                                .x_scale = chart_find_scale(chart, true, 0.05),
                                .y_scale = chart_find_scale(chart, false, 0.05)};
    legend = legend && (own.words->count > 0 || own.front);
    own.width = legend ? fmin(chart_legend_width(&own, context), 0.34 * area.width) : 0.0;
    const double left = chart_frame_left(&frame, context);
    frame.plot.left = area.left + left;
    frame.plot.width = area.width - left - (legend ? own.width + 1.5 * font : 1.5 * font);
    chart_frame_grid(&frame, context);
    struct chart_point *points = sort_points(chart);
    if (points == NULL) {
        render_text(context, frame.plot.left, frame.plot.top, 0.0, 0.0, "out of memory");
        return;
    }
    cairo_save(context);
    cairo_rectangle(context, frame.plot.left, frame.plot.top, frame.plot.width, frame.plot.height);
    cairo_clip(context);
    if (own.front)
        draw_front(chart, &frame, context, points);
    draw_points(chart, &frame, context, points);
    cairo_restore(context);
    free(points);
    if (chart->count == 0)
        draw_empty(chart, &frame, context);
    chart_frame_axes(&frame, context);
    if (legend)
        chart_legend_draw(&own, context, frame.plot.left + frame.plot.width + 1.2 * font, area.top);
}

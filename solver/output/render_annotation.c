/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_annotation.h"
#include "output/render_text.h"
#include "output/render_vector.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char *const axis_names[3] = {"x [m]", "y [m]", "z [m]"};

struct layout layout_find(int width, double aspect, bool with_bar)
{
    const double font = fmax(9.0, width / 80.0);
    const double left = 5.5 * font, right = with_bar ? 10.0 * font : 2.5 * font;
    const double top = 6.0 * font, bottom = 4.5 * font;
    const double plot_width = width - left - right;
    const double plot_height = fmin(fmax(plot_width * aspect, 8.0 * font), 1.1 * width);
    return (struct layout){.width = width,
                           .height = (int)ceil(top + plot_height + bottom),
                           .font = font,
                           .plot = {left, top, plot_width, plot_height}};
}

/* One axis along an edge of the view's box; labels stand on the side `outward` (unit, pixels). */
struct axis_line {
    double from[3], to[3];
    int axis;
    double outward[2];
};

static void draw_axis(cairo_t *context, const struct layout *layout, const struct view *view,
                      const struct axis_line *line)
{
    const struct screen_point from = view_project(view, line->from),
                              to = view_project(view, line->to);
    const double low = line->from[line->axis], high = line->to[line->axis];
    const double length = hypot(to.x - from.x, to.y - from.y), font = layout->font;
    cairo_set_line_width(context, fmax(1.0, font / 12.0));
    cairo_move_to(context, from.x, from.y);
    cairo_line_to(context, to.x, to.y);
    cairo_stroke(context);
    const double share_x = 0.5 - 0.5 * line->outward[0], share_y = 0.5 - 0.5 * line->outward[1];
    const struct ticks ticks = ticks_find(low, high, (int)fmax(1.0, length / (5.0 * font)));
    for (long index = ticks.first; index <= ticks.last; index++) {
        char text[32];
        const double share = ((double)index * ticks.step - low) / (high - low);
        const double x = from.x + share * (to.x - from.x), y = from.y + share * (to.y - from.y);
        cairo_move_to(context, x, y);
        cairo_line_to(context, x + 0.4 * font * line->outward[0],
                      y + 0.4 * font * line->outward[1]);
        cairo_stroke(context);
        ticks_format(&ticks, index, text, sizeof text);
        render_text(context, x + 0.7 * font * line->outward[0], y + 0.7 * font * line->outward[1],
                    share_x, share_y, text);
    }
    if (fabs(line->outward[0]) > 0.9) { /* beside an upright axis there is no room for its name */
        render_text(context, to.x, fmin(from.y, to.y) - 0.8 * font, 0.5, 1.0,
                    axis_names[line->axis]);
        return;
    }
    const double distance = 1.4 + 0.9 * fabs(line->outward[1]) + 1.6 * fabs(line->outward[0]);
    render_text(context, (from.x + to.x) / 2.0 + distance * font * line->outward[0],
                (from.y + to.y) / 2.0 + distance * font * line->outward[1], share_x, share_y,
                axis_names[line->axis]);
}

/* Which way is out of the box on the screen for an edge: away from the box's middle. */
static void find_outward(const struct view *view, struct axis_line *line)
{
    double middle[3];
    for (int axis = 0; axis < 3; axis++)
        middle[axis] = (view->box.min[axis] + view->box.max[axis]) / 2.0;
    const struct screen_point from = view_project(view, line->from),
                              to = view_project(view, line->to),
                              centre = view_project(view, middle);
    const double length = hypot(to.x - from.x, to.y - from.y);
    double x = -(to.y - from.y) / length, y = (to.x - from.x) / length;
    const double away =
        x * ((from.x + to.x) / 2.0 - centre.x) + y * ((from.y + to.y) / 2.0 - centre.y);
    line->outward[0] = away < 0.0 ? -x : x;
    line->outward[1] = away < 0.0 ? -y : y;
}

/* The edge of the box along `axis` that scores highest in a direction of the screen's frame. */
static struct axis_line choose_edge(const struct view *view, int axis, const double direction[3])
{
    struct axis_line best = {.axis = axis};
    double best_score = -INFINITY;
    for (int choice = 0; choice < 4; choice++) {
        double corner[3];
        for (int other = 0; other < 3; other++) {
            const bool high = (choice >> (other == (axis + 1) % 3) & 1) != 0;
            corner[other] = high ? view->box.max[other] : view->box.min[other];
        }
        corner[axis] = view->box.min[axis];
        const double score = vector_dot(corner, direction);
        if (score > best_score) {
            best_score = score;
            for (int other = 0; other < 3; other++)
                best.from[other] = best.to[other] = corner[other];
            best.to[axis] = view->box.max[axis];
        }
    }
    find_outward(view, &best);
    return best;
}

void annotate_axes(cairo_t *context, const struct layout *layout, const struct view *view,
                   const struct render_scene *scene)
{
    render_text_style(context, 0.9 * layout->font, false);
    for (int axis = 0; axis < 3; axis++) {
        double direction[3];
        if (axis >= (view->solid ? 3 : scene->axis_count))
            continue;
        /* Horizontal axes on the lower edges nearest to the eye, the vertical one on the left. */
        for (int other = 0; other < 3; other++) {
            const bool upright = axis == (view->solid ? scene->up_axis : 1);
            direction[other] = upright ? -view->right[other] : -view->up[other];
        }
        const struct axis_line line = choose_edge(view, axis, direction);
        draw_axis(context, layout, view, &line);
    }
}

static struct unit_prefix find_prefix(const char *unit, const struct colour_range *range)
{
    return render_prefix_find(unit, fmax(fabs(range->low), fabs(range->high)));
}

static void format_unit(const struct render_data *data, const struct colour_range *range,
                        char *text, size_t size)
{
    const struct unit_prefix prefix = find_prefix(data->unit, range);
    const bool plain = strcmp(data->unit, "1") == 0 || data->unit[0] == '\0';
    (void)snprintf(text, size, "%s%s", prefix.name, plain ? "-" : data->unit);
}

/* A pointed end says that values lie beyond the bar. */
static void draw_bar_end(cairo_t *context, const struct rectangle *bar, double y, double tip,
                         double position)
{
    const struct colour colour = colour_from_map(position);
    cairo_set_source_rgb(context, colour.red, colour.green, colour.blue);
    cairo_move_to(context, bar->left, y);
    cairo_line_to(context, bar->left + bar->width / 2.0, y + tip);
    cairo_line_to(context, bar->left + bar->width, y);
    cairo_fill(context);
}

void annotate_bar(cairo_t *context, const struct layout *layout, const struct render_data *data,
                  const struct colour_range *range)
{
    const double font = layout->font;
    const double height = fmin(layout->plot.height - 1.5 * font, 26.0 * font);
    const struct rectangle bar = {layout->plot.left + layout->plot.width + 2.5 * font,
                                  layout->plot.top + 1.5 * font, 1.2 * font, height};
    const int strips = (int)ceil(height);
    for (int strip = 0; strip < strips; strip++) {
        const struct colour colour = colour_from_map(1.0 - (strip + 0.5) / strips);
        cairo_set_source_rgb(context, colour.red, colour.green, colour.blue);
        cairo_rectangle(context, bar.left, bar.top + height * strip / strips, bar.width,
                        height / strips + 0.5);
        cairo_fill(context);
    }
    if (range->maximum > range->high)
        draw_bar_end(context, &bar, bar.top, -0.9 * font, 1.0);
    if (range->minimum < range->low)
        draw_bar_end(context, &bar, bar.top + height, 0.9 * font, 0.0);
    render_text_style(context, 0.9 * font, false);
    cairo_set_line_width(context, fmax(1.0, font / 14.0));
    const double factor = find_prefix(data->unit, range).factor;
    render_bar_ticks(context, font, &bar, factor * range->low, factor * range->high);
    char unit[48];
    format_unit(data, range, unit, sizeof unit);
    render_text(context, bar.left, bar.top - 1.3 * font, 0.0, 1.0, unit);
}

void annotate_title(cairo_t *context, const struct layout *layout, const char *title,
                    const struct render_data *data, const struct colour_range *range)
{
    char text[512], unit[48];
    cairo_text_extents_t extents;
    const double font = layout->font, left = 1.2 * font, room = layout->width - 2.0 * left;
    render_text_style(context, 1.25 * font, true);
    cairo_text_extents(context, title, &extents);
    if (extents.x_advance > room)
        cairo_set_font_size(context, 1.25 * font * room / extents.x_advance);
    render_text(context, left, 1.9 * font, 0.0, 1.0, title);
    format_unit(data, range, unit, sizeof unit);
    const double factor = find_prefix(data->unit, range).factor;
    if (data->values == NULL)
        (void)snprintf(text, sizeof text, "t = %.4g s, %zu particles", data->time, data->count);
    else
        (void)snprintf(text, sizeof text, "%s [%s], from %.4g to %.4g;  t = %.4g s, %zu particles",
                       data->label, unit, factor * range->minimum, factor * range->maximum,
                       data->time, data->count);
    render_text_style(context, font, false);
    render_text(context, left, 3.4 * font, 0.0, 1.0, text);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "output/chart_axis.h"

#include "output/render_colour.h"
#include "output/render_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LABEL_SIZE = 1100, LABEL_PART = 512 };

void chart_scale_add(struct chart_scale *scale, double value)
{
    scale->low = fmin(scale->low, value);
    scale->high = fmax(scale->high, value);
}

void chart_scale_finish(struct chart_scale *scale, double margin)
{
    bool empty = scale->low > scale->high;
    if (scale->logarithmic) {
        double low = empty ? 0.0 : log10(scale->low), high = empty ? 1.0 : log10(scale->high);
        double room = high - low < 1e-6 ? 0.5 : margin * (high - low);
        scale->low = pow(10.0, low - room);
        scale->high = pow(10.0, high + room);
        return;
    }
    if (empty) {
        scale->low = 0.0;
        scale->high = 1.0;
    }
    double size = fmax(fabs(scale->low), fabs(scale->high));
    double length = scale->high - scale->low;
    double room = length > 1e-9 * size ? margin * length : size > 0.0 ? 0.1 * size : 0.5;
    scale->low -= room;
    scale->high += room;
}

double chart_scale_share(const struct chart_scale *scale, double value)
{
    if (scale->logarithmic)
        return log10(value / scale->low) / log10(scale->high / scale->low);
    return (value - scale->low) / (scale->high - scale->low);
}

struct chart_scale chart_find_scale(const struct chart *chart, bool along_x, double margin)
{
    const struct chart_quantity *quantity = along_x ? &chart->x : &chart->y;
    struct chart_scale scale = {.low = INFINITY, .high = -INFINITY};
    if (chart_is_worded(quantity))
        return (struct chart_scale){.low = -0.5, .high = (double)quantity->words.count - 0.5};
    scale.logarithmic = quantity->logarithmic;
    for (size_t index = 0; index < chart->count; index++)
        chart_scale_add(&scale, along_x ? chart->points[index].x : chart->points[index].y);
    chart_scale_finish(&scale, margin);
    return scale;
}

/* "2e+05" becomes "2e5", and "0e+00" becomes "0". */
static void shorten_exponent(char *text)
{
    char *exponent = strchr(text, 'e');
    if (exponent == NULL)
        return;
    if (strtod(text, NULL) == 0.0) {
        text[0] = '0';
        text[1] = '\0';
        return;
    }
    const long power = strtol(exponent + 1, NULL, 10);
    (void)snprintf(exponent, 8, "e%ld", power);
}

static size_t linear_ticks(const struct chart_scale *scale, int wanted,
                           struct chart_tick ticks[CHART_TICK_MAX])
{
    const struct ticks found = ticks_find(scale->low, scale->high, wanted);
    size_t count = 0;
    for (long index = found.first; index <= found.last && count < CHART_TICK_MAX; index++) {
        struct chart_tick *tick = &ticks[count++];
        *tick = (struct chart_tick){.value = (double)index * found.step, .named = true};
        ticks_format(&found, index, tick->text, sizeof tick->text);
        shorten_exponent(tick->text);
    }
    return count;
}

/* Small numbers as they are; powers of ten keep their exponent and no text. */
static void name_decade(struct chart_tick *tick, int decade)
{
    tick->exponent = decade;
    if (decade >= -3 && decade <= 3)
        (void)snprintf(tick->text, sizeof tick->text, "%.*f", decade < 0 ? -decade : 0,
                       tick->value);
}

/* Every how many decades there is a number. */
static int decade_stride(int decades, int wanted)
{
    static const int strides[] = {1, 2, 3, 5, 10, 20, 50, 100};
    size_t index = 0;
    while (strides[index] < 100 && strides[index] * wanted < decades)
        index++;
    return strides[index];
}

static size_t logarithmic_ticks(const struct chart_scale *scale, int wanted,
                                struct chart_tick ticks[CHART_TICK_MAX])
{
    const int first = (int)floor(log10(scale->low)), last = (int)floor(log10(scale->high));
    const int decades = last - first + 1;
    const int stride = decade_stride(decades, wanted);
    const bool fine = 3 * decades <= wanted + 3 && first >= -3 && last <= 3;
    size_t count = 0, named = 0;
    for (int decade = first; decade <= last; decade++) {
        for (int digit = 1; digit <= (stride > 1 ? 1 : 9); digit++) {
            const double value = digit * pow(10.0, decade);
            const bool shown =
                digit == 1 ? (decade % stride) == 0 : fine && (digit == 2 || digit == 5);
            if (value < scale->low * (1.0 - 1e-9) || value > scale->high * (1.0 + 1e-9) ||
                count == CHART_TICK_MAX || (!shown && stride > 10))
                continue;
            ticks[count] = (struct chart_tick){.value = value, .named = shown};
            if (shown)
                name_decade(&ticks[count], decade);
            named += shown;
            count++;
        }
    }
    return named >= 2 ? count : linear_ticks(scale, wanted, ticks);
}

size_t chart_ticks(const struct chart_scale *scale, int wanted,
                   struct chart_tick ticks[CHART_TICK_MAX])
{
    wanted = wanted < 2 ? 2 : wanted > 20 ? 20 : wanted;
    return scale->logarithmic ? logarithmic_ticks(scale, wanted, ticks)
                              : linear_ticks(scale, wanted, ticks);
}

double chart_frame_x(const struct chart_frame *frame, double value)
{
    return frame->plot.left + frame->plot.width * chart_scale_share(&frame->x_scale, value);
}

double chart_frame_y(const struct chart_frame *frame, double value)
{
    return frame->plot.top + frame->plot.height * (1.0 - chart_scale_share(&frame->y_scale, value));
}

int chart_text_length(const char *text, int most)
{
    int length = 0;
    while (length < most && text[length] != '\0')
        length++;
    while (length > 0 && ((unsigned char)text[length] & 0xc0U) == 0x80U)
        length--;
    return length;
}

/* The ticks of an axis: of texts, one for each. */
static size_t axis_ticks(const struct chart_quantity *quantity, const struct chart_scale *scale,
                         int wanted, struct chart_tick ticks[CHART_TICK_MAX])
{
    const struct chart_words *words = &quantity->words;
    if (!chart_is_worded(quantity))
        return chart_ticks(scale, wanted, ticks);
    size_t count = words->count < CHART_TICK_MAX ? words->count : CHART_TICK_MAX;
    size_t stride = words->count / (size_t)(wanted < 1 ? 1 : wanted) + 1;
    for (size_t index = 0; index < count; index++) {
        ticks[index] = (struct chart_tick){.value = (double)index, .named = index % stride == 0};
        const char *word = words->items[index].text;
        (void)snprintf(ticks[index].text, sizeof ticks[index].text, "%.*s",
                       chart_text_length(word, 28), word);
    }
    return count;
}

static size_t x_ticks(const struct chart_frame *frame, struct chart_tick ticks[CHART_TICK_MAX])
{
    return axis_ticks(frame->x, &frame->x_scale, (int)(frame->plot.width / (5.0 * frame->font)),
                      ticks);
}

static size_t y_ticks(const struct chart_frame *frame, struct chart_tick ticks[CHART_TICK_MAX])
{
    return axis_ticks(frame->y, &frame->y_scale, (int)(frame->plot.height / (3.0 * frame->font)),
                      ticks);
}

/* The number of a tick, in the font that is set: text, or a power of ten. Returns its width and
 * draws it where the point has the given share of its box. */
static double tick_text(cairo_t *context, const struct chart_tick *tick, double size, bool draw,
                        double x, double y, double share_x, double share_y)
{
    char exponent[16];
    cairo_text_extents_t base, power;
    cairo_set_font_size(context, size);
    if (tick->text[0] != '\0') {
        cairo_text_extents(context, tick->text, &base);
        if (draw)
            render_text(context, x, y, share_x, share_y, tick->text);
        return base.x_advance;
    }
    (void)snprintf(exponent, sizeof exponent, "%s%d", tick->exponent < 0 ? "\xe2\x88\x92" : "",
                   abs(tick->exponent));
    cairo_text_extents(context, "10", &base);
    cairo_set_font_size(context, 0.75 * size);
    cairo_text_extents(context, exponent, &power);
    const double width = base.x_advance + power.x_advance, left = x - share_x * width;
    if (draw) {
        render_text(context, left + base.x_advance, y - 0.15 * size, 0.0, share_y + 0.45, exponent);
        cairo_set_font_size(context, size);
        render_text(context, left, y, 0.0, share_y, "10");
    }
    cairo_set_font_size(context, size);
    return width;
}

double chart_frame_left(const struct chart_frame *frame, cairo_t *context)
{
    struct chart_tick ticks[CHART_TICK_MAX];
    const size_t count = y_ticks(frame, ticks);
    double widest = 0.0;
    render_text_style(context, 0.9 * frame->font, false);
    for (size_t index = 0; index < count; index++) {
        if (ticks[index].named)
            widest = fmax(widest, tick_text(context, &ticks[index], 0.9 * frame->font, false, 0.0,
                                            0.0, 0.0, 0.0));
    }
    return fmin(widest, 12.0 * frame->font) + 3.2 * frame->font;
}

void chart_frame_grid(const struct chart_frame *frame, cairo_t *context)
{
    struct chart_tick ticks[CHART_TICK_MAX];
    const struct rectangle *plot = &frame->plot;
    cairo_set_line_width(context, fmax(0.5, frame->font / 18.0));
    for (int axis = 0; axis < 2; axis++) {
        const size_t count = axis == 0 ? x_ticks(frame, ticks) : y_ticks(frame, ticks);
        for (size_t index = 0; index < count; index++) {
            const double shade = ticks[index].named ? 0.87 : 0.95;
            cairo_set_source_rgb(context, shade, shade, shade);
            if (axis == 0) {
                cairo_move_to(context, chart_frame_x(frame, ticks[index].value), plot->top);
                cairo_rel_line_to(context, 0.0, plot->height);
            } else {
                cairo_move_to(context, plot->left, chart_frame_y(frame, ticks[index].value));
                cairo_rel_line_to(context, plot->width, 0.0);
            }
            cairo_stroke(context);
        }
    }
}

static void draw_x_axis(const struct chart_frame *frame, cairo_t *context)
{
    struct chart_tick ticks[CHART_TICK_MAX];
    char label[LABEL_SIZE];
    const double font = frame->font, bottom = frame->plot.top + frame->plot.height;
    const size_t count = x_ticks(frame, ticks);
    double behind = -INFINITY; /* of the last number */
    for (size_t index = 0; index < count; index++) {
        const double x = chart_frame_x(frame, ticks[index].value);
        cairo_move_to(context, x, bottom);
        cairo_rel_line_to(context, 0.0, (ticks[index].named ? 0.4 : 0.2) * font);
        cairo_stroke(context);
        const double half =
            0.5 * tick_text(context, &ticks[index], 0.9 * font, false, 0.0, 0.0, 0.0, 0.0);
        if (!ticks[index].named || x - half < behind + 0.4 * font)
            continue;
        (void)tick_text(context, &ticks[index], 0.9 * font, true, x, bottom + 0.7 * font, 0.5, 0.0);
        behind = x + half;
    }
    chart_quantity_label(frame->x, label, sizeof label);
    chart_text_fitted(context, frame->plot.left + 0.5 * frame->plot.width, bottom + 2.3 * font, 0.5,
                      0.0, frame->plot.width + 4.0 * font, font, label);
}

static void draw_y_axis(const struct chart_frame *frame, cairo_t *context)
{
    struct chart_tick ticks[CHART_TICK_MAX];
    char label[LABEL_SIZE];
    const double font = frame->font, left = frame->plot.left;
    const size_t count = y_ticks(frame, ticks);
    for (size_t index = 0; index < count; index++) {
        const double y = chart_frame_y(frame, ticks[index].value);
        cairo_move_to(context, left, y);
        cairo_rel_line_to(context, -(ticks[index].named ? 0.4 : 0.2) * font, 0.0);
        cairo_stroke(context);
        if (ticks[index].named)
            (void)tick_text(context, &ticks[index], 0.9 * font, true, left - 0.7 * font, y, 1.0,
                            0.5);
    }
    chart_quantity_label(frame->y, label, sizeof label);
    cairo_save(context);
    cairo_translate(context, left - chart_frame_left(frame, context) + 0.5 * font,
                    frame->plot.top + 0.5 * frame->plot.height);
    cairo_rotate(context, -M_PI / 2.0);
    chart_text_fitted(context, 0.0, 0.0, 0.5, 0.0, frame->plot.height + 3.0 * font, font, label);
    cairo_restore(context);
}

void chart_frame_axes(const struct chart_frame *frame, cairo_t *context)
{
    render_text_style(context, 0.9 * frame->font, false);
    cairo_set_line_width(context, fmax(1.0, frame->font / 12.0));
    cairo_rectangle(context, frame->plot.left, frame->plot.top, frame->plot.width,
                    frame->plot.height);
    cairo_stroke(context);
    draw_x_axis(frame, context);
    draw_y_axis(frame, context);
}

void chart_quantity_unit(const struct chart_quantity *quantity, char *text, size_t size)
{
    const char *unit = quantity->unit, *prefix = quantity->prefix.name;
    const bool plain = unit == NULL || strcmp(unit, "1") == 0;
    (void)snprintf(text, size, "%s%.*s", plain || prefix == NULL ? "" : prefix,
                   plain ? 0 : chart_text_length(unit, LABEL_PART), plain ? "" : unit);
}

void chart_quantity_label(const struct chart_quantity *quantity, char *text, size_t size)
{
    char shown[540];
    chart_quantity_unit(quantity, shown, sizeof shown);
    (void)snprintf(text, size, "%.*s%s%s%s", chart_text_length(quantity->name, LABEL_PART),
                   quantity->name, shown[0] == '\0' ? "" : " [", shown,
                   shown[0] == '\0' ? "" : "]");
}

void chart_text_fitted(cairo_t *context, double x, double y, double share_x, double share_y,
                       double room, double size, const char *text)
{
    char cut[LABEL_SIZE + 4];
    cairo_text_extents_t extents;
    cairo_set_font_size(context, size);
    cairo_text_extents(context, text, &extents);
    if (extents.x_advance > room) {
        cairo_set_font_size(context, fmax(0.75 * size, size * room / extents.x_advance));
        cairo_text_extents(context, text, &extents);
    }
    if (extents.x_advance <= 1.01 * room) {
        render_text(context, x, y, share_x, share_y, text);
        return;
    }
    int length = chart_text_length(text, LABEL_SIZE - 1);
    memcpy(cut, text, (size_t)length);
    do { /* letters from the end, until it fits with an ellipsis */
        length = chart_text_length(text, length > 0 ? length - 1 : 0);
        memcpy(cut + length, "\xe2\x80\xa6", 4);
        cairo_text_extents(context, cut, &extents);
    } while (length > 0 && extents.x_advance > room);
    render_text(context, x, y, share_x, share_y, cut);
}

void chart_bar_decades(cairo_t *context, double font, const struct rectangle *bar,
                       const struct chart_scale *scale)
{
    struct chart_tick ticks[CHART_TICK_MAX];
    const size_t count = chart_ticks(scale, (int)(bar->height / (3.0 * font)), ticks);
    for (size_t index = 0; index < count; index++) {
        const double right = bar->left + bar->width;
        const double y =
            bar->top + bar->height * (1.0 - chart_scale_share(scale, ticks[index].value));
        cairo_move_to(context, right, y);
        cairo_line_to(context, right + (ticks[index].named ? 0.3 : 0.15) * font, y);
        cairo_stroke(context);
        if (ticks[index].named)
            (void)tick_text(context, &ticks[index], 0.85 * font, true, right + 0.6 * font, y, 0.0,
                            0.5);
    }
}

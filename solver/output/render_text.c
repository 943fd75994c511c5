/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_text.h"
#include "output/render_colour.h"

#include <math.h>
#include <string.h>

void render_text_style(cairo_t *context, double size, bool bold)
{
    cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context, size);
    cairo_set_source_rgb(context, 0.15, 0.16, 0.18);
}

void render_text(cairo_t *context, double x, double y, double share_x, double share_y,
                 const char *text)
{
    cairo_text_extents_t text_size;
    cairo_font_extents_t font_size;
    cairo_text_extents(context, text, &text_size);
    cairo_font_extents(context, &font_size);
    const double height = 0.72 * font_size.ascent; /* of digits and capitals */
    cairo_move_to(context, x - share_x * text_size.x_advance, y + (1.0 - share_y) * height);
    cairo_show_text(context, text);
}

struct unit_prefix render_prefix_find(const char *unit, double size)
{
    static const char *const plain[] = {"Pa", "N", "J", "N/m", "J/m"};
    for (size_t index = 0; index < sizeof plain / sizeof plain[0]; index++) {
        if (strcmp(unit, plain[index]) != 0 || size < 2e3)
            continue;
        return size < 2e6   ? (struct unit_prefix){1e-3, "k"}
               : size < 2e9 ? (struct unit_prefix){1e-6, "M"}
                            : (struct unit_prefix){1e-9, "G"};
    }
    return (struct unit_prefix){1.0, ""};
}

void render_bar_ticks(cairo_t *context, double font, const struct rectangle *bar, double low,
                      double high)
{
    const struct ticks ticks = ticks_find(low, high, (int)fmax(2.0, bar->height / (3.0 * font)));
    for (long index = ticks.first; index <= ticks.last; index++) {
        char text[32];
        const double share = ((double)index * ticks.step - low) / (high - low);
        const double y = bar->top + bar->height * (1.0 - share);
        cairo_move_to(context, bar->left + bar->width, y);
        cairo_line_to(context, bar->left + bar->width + 0.3 * font, y);
        cairo_stroke(context);
        ticks_format(&ticks, index, text, sizeof text);
        render_text(context, bar->left + bar->width + 0.6 * font, y, 0.0, 0.5, text);
    }
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Text and tick marks of colour bars, for pictures of frames and for charts. */
#ifndef TALUS_RENDER_TEXT_H
#define TALUS_RENDER_TEXT_H

#include "output/render_view.h"

#include <cairo.h>
#include <stdbool.h>

/* The font of all pictures at a size in pixels, in the colour of text. */
void render_text_style(cairo_t *context, double size, bool bold);

/* Draws text so that the point lies at the given share of its width and height (0, 0: top left;
 * 1, 1: bottom right). */
void render_text(cairo_t *context, double x, double y, double share_x, double share_y,
                 const char *text);

/* A prefix that keeps the numbers of an axis readable; only for units that take one. */
struct unit_prefix {
    double factor; /* from values in the unit to numbers with the prefix */
    const char *name;
};
/* For a unit and the largest magnitude of its values. */
struct unit_prefix render_prefix_find(const char *unit, double size);

/* Marks and numbers at the right side of an upright colour bar that goes from low to high. */
void render_bar_ticks(cairo_t *context, double font, const struct rectangle *bar, double low,
                      double high);

#endif

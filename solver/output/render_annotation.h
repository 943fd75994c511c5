/* SPDX-License-Identifier: Apache-2.0 */
/* What stands around the picture: axes in metres, colour bar, title. */
#ifndef TALUS_RENDER_ANNOTATION_H
#define TALUS_RENDER_ANNOTATION_H

#include "output/render_colour.h"
#include "output/render_data.h"
#include "output/render_view.h"

#include <cairo.h>

/* Where things go in a picture of a given width. */
struct layout {
    int width, height;     /* [pixels] */
    double font;           /* [pixels] size of the text */
    struct rectangle plot; /* what is in space */
};
struct layout layout_find(int width, double aspect, bool with_bar);

void annotate_axes(cairo_t *context, const struct layout *layout, const struct view *view,
                   const struct render_scene *scene);
void annotate_bar(cairo_t *context, const struct layout *layout, const struct render_data *data,
                  const struct colour_range *range);
void annotate_title(cairo_t *context, const struct layout *layout, const char *title,
                    const struct render_data *data, const struct colour_range *range);

#endif

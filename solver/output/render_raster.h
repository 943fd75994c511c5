/* SPDX-License-Identifier: Apache-2.0 */
/* A picture with a depth buffer: what is nearer to the eye hides what is behind it, in whatever
 * order things are drawn. */
#ifndef TALUS_RENDER_RASTER_H
#define TALUS_RENDER_RASTER_H

#include <stdbool.h>
#include <stdint.h>

struct colour { /* each 0..1, sRGB */
    double red, green, blue;
};

struct screen_point { /* pixels, y down; depth grows away from the eye, in pixels as well */
    double x, y, depth;
};

struct raster {
    int width, height;
    uint32_t *pixels; /* [width * height] 0x00RRGGBB */
    float *depth;     /* [width * height], INFINITY where nothing is drawn */
};

/* A white picture. False when memory ran out; release it in any case. */
bool raster_init(struct raster *raster, int width, int height);
void raster_release(struct raster *raster);

/* A disc facing the eye, with a radius in pixels; `round` shades it as a sphere. */
void raster_draw_disc(struct raster *raster, struct screen_point centre, double radius,
                      struct colour colour, bool round);

/* A filled flat quadrilateral, corners in cyclic order, in one colour. */
void raster_draw_quad(struct raster *raster, const struct screen_point corners[4],
                      struct colour colour);

/* A line of the given width in pixels, hidden by what is nearer by more than half a width. */
void raster_draw_line(struct raster *raster, struct screen_point from, struct screen_point to,
                      double width, struct colour colour);

/* The colour in a light of the given strength (1: as it is, 0: black). */
struct colour colour_shade(struct colour colour, double light);

#endif

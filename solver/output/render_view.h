/* SPDX-License-Identifier: Apache-2.0 */
/* Which part of space a picture shows, and where a point of it lies on the screen. */
#ifndef TALUS_RENDER_VIEW_H
#define TALUS_RENDER_VIEW_H

#include "output/render_raster.h"
#include "output/render_scene.h"

#include <stdbool.h>
#include <stddef.h>

struct box3 {
    double min[3], max[3]; /* [m] */
};

struct rectangle { /* pixels, y down */
    double left, top, width, height;
};

struct view {
    bool solid;      /* an orthographic view of space; else the plane of the scene, face on */
    struct box3 box; /* what is shown */
    double right[3], up[3], toward[3]; /* unit vectors of the screen in space; toward the eye */
    double scale;                      /* [pixels / m] */
    double left, top;                  /* [pixels] of the origin of space */
};

/* The box that holds both sets of positions[3 * count], grown outwards to round numbers and cut at
 * the grid; obstacles count as far as they reach half above the particles. `before` may be NULL. */
struct box3 view_find_box(const struct render_scene *scene, const double *positions, size_t count,
                          const double *before, size_t before_count);

/* Looks at the box, unscaled (scale 1): height / width of what the screen shows follows from it.
 */
void view_init(struct view *view, const struct render_scene *scene, struct box3 box);
double view_aspect(const struct view *view);

/* Scales and places the view so that its box fills the rectangle as far as it can. */
void view_fit(struct view *view, struct rectangle area);

/* How much light (0..1) a surface with that outward normal, of any length, gets. */
double view_light(const struct view *view, const double normal[3]);

struct screen_point view_project(const struct view *view, const double position[3]);

#endif

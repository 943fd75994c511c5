/* SPDX-License-Identifier: Apache-2.0 */
/* Draws what is in space: particles and boundaries. The view is scaled to the raster's pixels. */
#ifndef TALUS_RENDER_DRAWING_H
#define TALUS_RENDER_DRAWING_H

#include "output/render.h"
#include "output/render_colour.h"
#include "output/render_data.h"
#include "output/render_view.h"

void draw_particles(struct raster *raster, const struct view *view,
                    const struct render_scene *scene, const struct render_data *data,
                    const struct colour_range *range, enum render_style style);

void draw_boundaries(struct raster *raster, const struct view *view,
                     const struct render_scene *scene, double line_width);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* What advice asks of bodies, boundaries and materials. */
#ifndef TALUS_SCENE_GEOMETRY_H
#define TALUS_SCENE_GEOMETRY_H

#include "talus/scene.h"

#include <stdbool.h>

/* Equal but for rounding, as seen from lengths of `scale`. */
bool scene_near(double a, double b, double scale);

/* Box of the world [m] that holds a body. */
void scene_body_bounds(const struct talus_scene *scene, const struct talus_body *body,
                       double min[3], double max[3]);

/* True if the boundary is a plane across the axis, at most half a cell from `place` [m], that looks
 * along it (side 1) or against it (side -1). */
bool scene_plane_is_at(const struct talus_scene *scene, const struct talus_boundary *boundary,
                       size_t axis, double place, int side);
/* The same, if it is also a smooth one that holds everything at all times: a mirror. */
bool scene_mirror_is_at(const struct talus_scene *scene, const struct talus_boundary *boundary,
                        size_t axis, double place, int side);

/* Half the extent along an axis of a face, whose box is the product of these [m]. */
double scene_face_half(const struct talus_boundary *face, size_t axis);

/* Speed of the fastest wave [m/s]. */
double scene_wave_speed(const struct talus_material *material);
/* Poisson's ratio; 0.5 for fluids. */
double scene_poisson_ratio(const struct talus_material *material);

#endif

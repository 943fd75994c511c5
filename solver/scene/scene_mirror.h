/* SPDX-License-Identifier: Apache-2.0 */
/* Whether one entry of a scene is the mirror image of another, about a plane across an axis. What
 * cannot be told counts as no image. */
#ifndef TALUS_SCENE_MIRROR_H
#define TALUS_SCENE_MIRROR_H

#include "scene/scene_geometry.h"

struct scene_mirror {
    const struct talus_scene *scene;
    size_t axis;
    double centre; /* [m] of the plane */
};

/* True if coordinate b on axis k is the image of a. */
bool scene_mirror_near(const struct scene_mirror *mirror, size_t k, double a, double b);

/* Entries of the scene of the mirror; a may be b. */
bool scene_mirror_bodies(const struct scene_mirror *mirror, const struct talus_body *a,
                         const struct talus_body *b);
bool scene_mirror_boundaries(const struct scene_mirror *mirror, const struct talus_boundary *a,
                             const struct talus_boundary *b);

#endif

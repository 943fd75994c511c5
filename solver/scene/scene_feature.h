/* SPDX-License-Identifier: Apache-2.0 */
/* The thing in a scene that has the fewest cells for what it is. */
#ifndef TALUS_SCENE_FEATURE_H
#define TALUS_SCENE_FEATURE_H

#include "talus/scene.h"

struct scene_feature {
    double cells;            /* across it; INFINITY: there is none */
    double least;            /* as few are too few */
    size_t axis;             /* on which it is so small */
    const char *kind, *name; /* "body", "obstacle", "face", "opening at"; name in the scene */
    const char *consequence; /* of too few cells */
};

/* Bodies that end in the open or at another material, obstacles, faces, and openings between
 * obstacles and walls. */
struct scene_feature scene_smallest_feature(const struct talus_scene *scene);

#endif

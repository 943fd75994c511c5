/* SPDX-License-Identifier: Apache-2.0 */
/* How fast the loads of a scene come, against how fast its solids vibrate. */
#ifndef TALUS_SCENE_LOADING_H
#define TALUS_SCENE_LOADING_H

#include "talus/scene.h"

#include <stdbool.h>

enum scene_loading_kind {
    SCENE_LOADING_OTHER,    /* moves at the start, flows, falls, or cannot be told */
    SCENE_LOADING_SLOW,     /* what is held deforms as walls move or loads grow */
    SCENE_LOADING_CONSTANT, /* elastic bodies that are held carry the same load from the start on */
};

struct scene_loading {
    enum scene_loading_kind kind;
    double period;         /* [s] of the slowest vibration, rather too long than too short */
    double load_time;      /* [s] over which loads grow (SLOW) */
    double push_speed;     /* [m/s] of the fastest wall, 0: none */
    double push_speed_max; /* [m/s] at which it would still be slow, against waves and falls */
};

void scene_loading_init(struct scene_loading *loading, const struct talus_scene *scene);

/* True if gravity or a traction follows a table. */
bool scene_loading_has_tables(const struct talus_scene *scene);

#endif

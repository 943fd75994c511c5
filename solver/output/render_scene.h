/* SPDX-License-Identifier: Apache-2.0 */
/* What a picture needs from a job's scene.json (the effective scene): no physics. */
#ifndef TALUS_RENDER_SCENE_H
#define TALUS_RENDER_SCENE_H

#include "talus/status.h"

#include <stdbool.h>
#include <stddef.h>

enum render_boundary_kind { RENDER_PLANE, RENDER_FACE, RENDER_BOX };

struct render_boundary {
    enum render_boundary_kind kind;
    double point[3], normal[3]; /* plane and face; unit normal into the material */
    double min[3], max[3];      /* box; face: its extent (infinite where it is not given) */
};

struct render_scene {
    char title[160];
    int axis_count; /* 1, 2 or 3 */
    bool revolves;  /* axisymmetric: x is the distance from the axis */
    int up_axis;    /* 0..2: against gravity; 1 without gravity */
    double up_sign; /* +1 or -1 along it */
    double cell[3]; /* [m] of the grid; 0 beyond the dimension */
    double grid_min[3], grid_max[3];
    double spacing;                     /* [m] smallest distance between particles at the start */
    struct render_boundary *boundaries; /* [boundary_count] */
    size_t boundary_count;
};

/* Release the scene in any case. TALUS_IO if the file is not a scene, TALUS_MEMORY. */
TALUS_MUST_CHECK enum talus_status render_scene_read(struct render_scene *scene, const char *path,
                                                     struct talus_error *error);
void render_scene_release(struct render_scene *scene);

#endif

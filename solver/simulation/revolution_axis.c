/* SPDX-License-Identifier: Apache-2.0 */
#include "simulation/simulation_private.h"

#include <stdlib.h>
#include <string.h>

static const struct talus_boundary axis = {
    .shape = TALUS_BOUNDARY_PLANE,
    .normal = {1, 0, 0},
    .face_count = 1,
    .wall = TALUS_WALL_STOP,
    .body_index = -1,
    .internal = true,
};

int scene_add_axis(struct talus_scene *scene)
{
    struct talus_boundary *boundaries =
        realloc(scene->boundaries, (scene->boundary_count + 1) * sizeof *boundaries);
    if (boundaries == NULL)
        return -1;
    scene->boundaries = boundaries;
    struct talus_boundary *added = &boundaries[scene->boundary_count];
    *added = axis;
    added->name = strdup("axis of revolution");
    if (added->name == NULL)
        return -1;
    const struct boundary_condition *slip = boundary_find("slip");
    while (boundary_table[added->faces[0].condition_index] != slip)
        added->faces[0].condition_index++;
    scene->boundary_count++;
    return 0;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* The document that `talus-worker point` runs: a material and a path. */
#ifndef TALUS_SCENE_POINT_H
#define TALUS_SCENE_POINT_H

#include "materials/material_point.h"
#include "scene/scene_json.h"

struct scene_point { /* owns what it points to; release it */
    struct talus_material material;
    int strain;                             /* index of "small", "finite" */
    double initial_stress[SYM3_COMPONENTS]; /* [Pa] */
    struct material_point_segment *path;
    size_t segment_count;
};

/* Reads and validates a file, all mistakes at once; *point is filled on TALUS_OK and must be
 * released then. The caller releases *issues in any case. */
TALUS_MUST_CHECK enum talus_status
scene_point_read_file(const char *path, struct scene_point *point, struct scene_issues *issues);
/* The same from a document in memory. */
TALUS_MUST_CHECK enum talus_status scene_point_read(const json_t *root, struct scene_point *point,
                                                    struct scene_issues *issues);

/* The path as the material point runs it; borrows from the point. */
struct material_point_path scene_point_path(const struct scene_point *point);

/* Accepts a zeroed point. */
void scene_point_release(struct scene_point *point);

#endif

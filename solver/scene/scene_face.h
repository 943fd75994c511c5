/* SPDX-License-Identifier: Apache-2.0 */
/* The rectangle of a boundary, in either of its two forms, and unit normals. */
#ifndef TALUS_SCENE_FACE_H
#define TALUS_SCENE_FACE_H

#include "scene/scene_field.h"

/* {min, max, normal} flat on an axis, or {point, normal, size}: fills point, normal, axis_1,
 * axis_2, size of the boundary. */
void scene_face_read(struct scene_reader *reader, const struct scene_path *path,
                     const json_t *given, struct talus_boundary *boundary, json_t *effective);
json_t *scene_face_schema(void);

/* Makes a direction a unit vector, also in `effective` (object with the key "normal" or "along",
 * the last key of the path being its parent); a mistake if it has no length. NAN is left alone. */
bool scene_face_normalise(struct scene_reader *reader, const struct scene_path *parent,
                          double normal[3], json_t *effective);

/* The same for any key. */
bool scene_direction_normalise(struct scene_reader *reader, const struct scene_path *path,
                               double direction[3], json_t *effective);

#endif

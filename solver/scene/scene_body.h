/* SPDX-License-Identifier: Apache-2.0 */
/* Parts of an entry of `bodies` that have a file of their own. All read into a struct talus_body
 * (the target), as the `read` and `schema` of a custom field do. Private to solver/scene. */
#ifndef TALUS_SCENE_BODY_H
#define TALUS_SCENE_BODY_H

#include "scene/scene_field.h"

/* `velocity`: a vector, {"rotation": ...} or {"beam_mode": ...}; nothing: at rest. */
void scene_body_velocity_read(struct scene_reader *reader, const struct scene_path *path,
                              const json_t *given, void *target, json_t *effective);
json_t *scene_body_velocity_schema(void);

/* Tables of `polygon` and `points`. */
extern const struct scene_field scene_polygon_fields[];
extern const struct scene_field scene_points_fields[];

/* `rotate`: {angle, about, axis}; nothing: not turned. */
void scene_body_rotate_read(struct scene_reader *reader, const struct scene_path *path,
                            const json_t *given, void *target, json_t *effective);
json_t *scene_body_rotate_schema(void);

/* `traction`: a list of loads on faces. The shape and the clip box are known. */
void scene_body_traction_read(struct scene_reader *reader, const struct scene_path *path,
                              const json_t *given, void *target, json_t *effective);
json_t *scene_body_traction_schema(void);

#endif

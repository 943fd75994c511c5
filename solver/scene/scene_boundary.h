/* SPDX-License-Identifier: Apache-2.0 */
/* A boundary while its keys are read. Private to solver/scene. */
#ifndef TALUS_SCENE_BOUNDARY_H
#define TALUS_SCENE_BOUNDARY_H

#include "scene/scene_condition.h"

#include "talus/scene.h"

struct boundary_keys {
    struct scene_condition condition; /* first: see SCENE_CONDITION_FIELDS */
    struct scene_condition faces[6];  /* overrides; index SIZE_MAX: none */
    struct talus_boundary boundary;
    double moment_about[3]; /* NAN: not given */
    double from, until;     /* NAN: not given */
    const char *name;
};

/* ---- scene_boundary_motion.c: keys that tell how a boundary changes over time ---- */
void scene_boundary_velocity_read(struct scene_reader *reader, const struct scene_path *path,
                                  const json_t *given, void *target, json_t *effective);
json_t *scene_boundary_velocity_schema(void);
void scene_boundary_components_read(struct scene_reader *reader, const struct scene_path *path,
                                    const json_t *given, void *target, json_t *effective);
json_t *scene_boundary_components_schema(void);
/* Checks them against each other and the conditions, and fills in what they leave open. */
void scene_boundary_motion_finish(struct scene_reader *reader, const struct scene_path *path,
                                  const json_t *given, struct boundary_keys *keys,
                                  json_t *effective);

#endif

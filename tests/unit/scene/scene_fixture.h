/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes as text, and small changes to them. */
#ifndef TALUS_SCENE_FIXTURE_H
#define TALUS_SCENE_FIXTURE_H

#include "scene/scene_json.h"

enum fixture_base {
    BASE_PLANE, /* plane strain: cap model, plane and box boundaries, probes, references */
    BASE_SOLID, /* solid: elastic block, face and plane boundaries */
    BASE_FLUID, /* plane strain: water */
    BASE_AXIAL, /* axisymmetric: an elastic ball */
};

/* A new reference to the scene. */
json_t *fixture_scene(enum fixture_base base);

/* Sets (value: JSON text) or removes (NULL) what a JSON Pointer names; "-" appends to an array. */
void fixture_change(json_t *root, const char *pointer, const char *value);

/* What scene_read says of a scene. Release it with fixture_result_release. */
struct fixture_result {
    enum talus_status status;
    struct talus_scene scene;
    json_t *effective;
    struct scene_issues issues, warnings;
};
void fixture_read(const json_t *root, struct fixture_result *result);
/* Reads a scene that must be valid (the reference is taken). */
struct fixture_result fixture_read_valid(json_t *scene);
void fixture_result_release(struct fixture_result *result);

/* The first issue with that pointer and code, or NULL. */
const struct scene_issue *fixture_find(const struct scene_issues *issues, const char *pointer,
                                       const char *code);

#endif

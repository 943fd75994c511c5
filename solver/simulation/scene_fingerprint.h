/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_SCENE_FINGERPRINT_H
#define TALUS_SCENE_FINGERPRINT_H

#include "talus/scene.h"

#include <stdint.h>

/* Hash of everything in a scene that a checkpoint depends on, and of the build: grid, solver,
 * materials, bodies, gravity, boundaries, probes and the fields that are tracked. Not of its title,
 * its end (which steering moves) and when output is due. */
uint64_t scene_fingerprint(const struct talus_scene *scene);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_SCENE_COPY_H
#define TALUS_SCENE_COPY_H

#include "talus/scene.h"

/* Deep copy; release it with talus_scene_release. 0, or -1 when memory ran out (copy is then
 * empty). */
int scene_copy(const struct talus_scene *scene, struct talus_scene *copy);

#endif

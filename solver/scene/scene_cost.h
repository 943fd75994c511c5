/* SPDX-License-Identifier: Apache-2.0 */
/* Bytes that a run writes: for its forecast, and for advice on its output. */
#ifndef TALUS_SCENE_COST_H
#define TALUS_SCENE_COST_H

#include "talus/scene.h"

/* Of all frames together, without compression. */
double scene_frame_bytes(const struct talus_scene *scene, double particles);
/* Of all rows of the history, in the files that hold them. */
double scene_history_bytes(const struct talus_scene *scene);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* What a helper is asked of a scene. */
#ifndef TALUS_SCENE_QUESTION_H
#define TALUS_SCENE_QUESTION_H

#include "service.h"

#include <jansson.h>

/* {"op": "check", "scene", "threads", "calibration"}: with what this machine has shown and how busy
 * it is; new reference, NULL without memory. `scene` is borrowed. `threads` 0: as many as pay and
 * can run. */
json_t *scene_question(struct service *service, const json_t *scene, int64_t threads);

/* The member `calibration` of a question for a run with so many threads. */
json_t *scene_question_calibration(struct service *service, int64_t threads);

#endif

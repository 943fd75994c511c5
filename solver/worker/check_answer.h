/* SPDX-License-Identifier: Apache-2.0 */
/* What is known of a scene before it runs, as one JSON object; shared by `check` and `helper`. */
#ifndef TALUS_CHECK_ANSWER_H
#define TALUS_CHECK_ANSWER_H

#include <jansson.h>

#include "scene/scene_json.h"

/* {"ok":true,"effective","forecast","advice","warnings","hash","build"} or
 * {"ok":false,"errors":[...]}; new reference, NULL without memory. `threads`: with which the run is
 * forecast; `calibration` (or NULL): by what (scene/scene_calibration.h). */
json_t *check_answer(const json_t *scene, int threads, const json_t *calibration);

/* The same for a file; a text that is not JSON is one error with line and column. */
json_t *check_answer_file(const char *path, int threads, const json_t *calibration);

/* {"ok":false,"errors":[{"pointer","code","detail"}]} of a single error. */
json_t *check_answer_error(const char *pointer, const char *code, const char *detail);

#endif

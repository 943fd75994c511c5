/* SPDX-License-Identifier: Apache-2.0 */
/* Which choices of a scene's method go together. */
#ifndef TALUS_METHOD_CHECK_H
#define TALUS_METHOD_CHECK_H

#include "talus/scene.h"
#include "talus/status.h"

/* TALUS_OK, or why a simulation of this scene is refused, with the pointer of the key to change. */
TALUS_MUST_CHECK enum talus_status method_check(const struct talus_scene *scene,
                                                struct talus_error *error);

#endif

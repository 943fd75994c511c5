/* SPDX-License-Identifier: Apache-2.0 */
/* How particles store their share of the loaded faces of their body: the tractions of a body one
 * after the other, each with its area or, for a pressure, its area times the outward normal at
 * t = 0, one component an axis. Bodies share the components. */
#ifndef TALUS_TRACTION_LAYOUT_H
#define TALUS_TRACTION_LAYOUT_H

#include "talus/scene.h"

/* A body has at most this many tractions. */
enum { TRACTION_MAX = 8 };

static inline size_t traction_components(const struct talus_scene *scene,
                                         const struct talus_traction *traction)
{
    return traction->is_pressure ? scene->axis_count : 1;
}

/* First component of a traction of a body; of the one past the last: the number of components. */
static inline size_t traction_offset(const struct talus_scene *scene, const struct talus_body *body,
                                     size_t index)
{
    size_t offset = 0;
    for (size_t before = 0; before < index; before++)
        offset += traction_components(scene, &body->tractions[before]);
    return offset;
}

/* Components that the bodies of a scene need. */
static inline size_t traction_component_count(const struct talus_scene *scene)
{
    size_t most = 0;
    for (size_t index = 0; index < scene->body_count; index++) {
        const struct talus_body *body = &scene->bodies[index];
        const size_t count = traction_offset(scene, body, body->traction_count);
        most = count > most ? count : most;
    }
    return most;
}

#endif

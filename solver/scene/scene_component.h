/* SPDX-License-Identifier: Apache-2.0 */
/* Names of components: x, y, z of vectors, xx ... of tensors. */
#ifndef TALUS_SCENE_COMPONENT_H
#define TALUS_SCENE_COMPONENT_H

#include "scene/scene_reader.h"

/* Words for the components of a quantity with `count` of them (1, 3, 6 or 9), NULL-terminated;
 * entries that do not exist in the dimension are "". */
void scene_component_words(size_t count, size_t axis_count, const char *words[10]);

/* Reads "component" of a quantity: index, or -1 where not given (all of them) or wrong (with a
 * mistake). */
int scene_component_read(struct scene_reader *reader, const struct scene_path *path,
                         const json_t *given, const char *const words[10]);

/* x, y, z and all of a matrix, NULL-terminated: what a component can be called at all. */
extern const char *const scene_component_names[];
extern const char *const scene_field_words[]; /* of fields.def, NULL-terminated */
size_t scene_field_components(size_t field);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Numbers and vectors whose components may be tables over time: [[t, value], ...], linear between
 * the points, constant outside. Private to solver/scene. */
#ifndef TALUS_SCENE_TIME_TABLE_H
#define TALUS_SCENE_TIME_TABLE_H

#include "scene/scene_field.h"

#include "talus/scene.h"

/* Reads a number or a table of them, each within the bounds of `field`. *value is the number, or
 * the value at t = 0; *table has no points for a number, and owns its arrays otherwise. False (and
 * mistakes, *table without points) if it is neither. */
bool scene_timed_number_read(struct scene_reader *reader, const struct scene_path *path,
                             const struct scene_field *field, const json_t *given, double *value,
                             struct talus_time_table *table, json_t **effective);

/* The same for a vector with one number or table per axis. */
bool scene_timed_vector_read(struct scene_reader *reader, const struct scene_path *path,
                             const struct scene_field *field, const json_t *given, double value[3],
                             struct talus_time_table tables[3], json_t **effective);

/* JSON Schemas of the two; `field` is that of a plain number or vector. */
json_t *scene_timed_number_schema(const struct scene_field *field);
json_t *scene_timed_vector_schema(const struct scene_field *field);

#endif

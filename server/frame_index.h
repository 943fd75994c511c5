/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_FRAME_INDEX_H
#define TALUS_FRAME_INDEX_H

#include <jansson.h>

/* The frames that a job's event file tells of, by number, without those that a resume made void:
 * [{"n", "time", "step", "particles", "fields", "bytes", "sha256"}]. New reference, NULL
 * if the file cannot be read. */
json_t *frame_index_read(const char *folder);

/* "12" -> 12; -1 for anything else. */
json_int_t frame_index_number(const char *name);
/* The frame of that number among those (borrowed), or NULL. */
const json_t *frame_index_find(const json_t *frames, json_int_t number);

#endif

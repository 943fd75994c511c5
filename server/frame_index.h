/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_FRAME_INDEX_H
#define TALUS_FRAME_INDEX_H

#include <jansson.h>

/* The frames that a job's event file tells of, by number, without those that a resume made void:
 * [{"n", "time", "step", "particles", "fields", "bytes", "sha256", "file"}]. New reference, NULL
 * if the file cannot be read. */
json_t *frame_index_read(const char *folder);

#endif

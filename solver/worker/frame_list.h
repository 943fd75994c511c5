/* SPDX-License-Identifier: Apache-2.0 */
/* The frames a run has written, and the files that list them: frames.hdf.series, grid.hdf.series
 * and vtk/frames.pvd (ParaView). */
#ifndef TALUS_FRAME_LIST_H
#define TALUS_FRAME_LIST_H

#include "talus/status.h"

#include <jansson.h>
#include <stddef.h>
#include <stdint.h>

struct frame_entry {
    double time; /* [s] */
    uint64_t step, particles, bytes;
    char sha256[65];
};
struct frame_list {
    struct frame_entry *entries;
    size_t count, capacity;
};

TALUS_MUST_CHECK enum talus_status
frame_list_add(struct frame_list *list, const struct frame_entry *entry, struct talus_error *error);
void frame_list_release(struct frame_list *list);

/* As JSON for a checkpoint (new reference, NULL when memory ran out), and back. */
json_t *frame_list_json(const struct frame_list *list);
TALUS_MUST_CHECK enum talus_status frame_list_read(struct frame_list *list, const json_t *array,
                                                   struct talus_error *error);

/* Replaces `path` by a ParaView series of files `prefix`000000.hdf ... */
TALUS_MUST_CHECK enum talus_status frame_list_write_series(const struct frame_list *list,
                                                           const char *path, const char *prefix,
                                                           struct talus_error *error);
/* Replaces `path` by a ParaView data collection (.pvd) of frame_000000.vtu ... beside it. */
TALUS_MUST_CHECK enum talus_status
frame_list_write_pvd(const struct frame_list *list, const char *path, struct talus_error *error);

/* Removes files PREFIX_NNNNNN.* of `folder` with a number of `count` or more. */
TALUS_MUST_CHECK enum talus_status frame_list_trim(const char *folder, size_t count,
                                                   struct talus_error *error);

#endif

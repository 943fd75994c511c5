/* SPDX-License-Identifier: Apache-2.0 */
/* Arrays out of a frame file (VTKHDF, written by output/frame.h). */
#ifndef TALUS_FRAME_READ_H
#define TALUS_FRAME_READ_H

#include "output/hdf5_file.h"
#include "talus/status.h"

#include <stddef.h>

/* An array of a frame as it was read; free `values`. */
struct frame_values {
    size_t count, components;
    double *values; /* [count * components], NULL: there is no such array */
    char unit[32];
};

/* Opens a frame for reading; close it with H5Fclose. TALUS_INVALID (/frame) if there is none. */
TALUS_MUST_CHECK enum talus_status frame_read_open(const char *path, hid_t *file,
                                                   struct talus_error *error);
/* Reads group/name. TALUS_IO if it is not an array of a frame, TALUS_MEMORY. */
TALUS_MUST_CHECK enum talus_status frame_read_array(hid_t group, const char *name,
                                                    struct frame_values *out,
                                                    struct talus_error *error);
/* TALUS_IO: a dataset is not as it should be. */
enum talus_status frame_read_failed(struct talus_error *error, const char *name);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* A frame as a browser reads it: a little-endian uint32, the length of the JSON header behind it,
 * padded with blanks to a multiple of 4; then, at the offsets that the header tells from its end,
 * arrays of little-endian float32, interleaved. */
#ifndef TALUS_FRAME_SLICE_H
#define TALUS_FRAME_SLICE_H

#include "talus/status.h"

#include <stddef.h>
#include <stdint.h>

struct frame_slice_request {
    const char *folder;        /* of the job */
    uint64_t frame;            /* number of the frame */
    const char *const *fields; /* [field_count] names, without the positions, which come always */
    size_t field_count;
    uint64_t stride;    /* every so many particles, in the order of their ids; at least 1 */
    const char *output; /* path of the slice; written aside and renamed */
};

/* Largest slice [bytes]. */
extern const uint64_t frame_slice_bytes_max;

/* TALUS_INVALID for a frame (/frame) or field (/fields) that does not exist and for more bytes than
 * allowed (/stride), TALUS_IO, TALUS_MEMORY. */
TALUS_MUST_CHECK enum talus_status frame_slice_write(const struct frame_slice_request *request,
                                                     struct talus_error *error);

#endif

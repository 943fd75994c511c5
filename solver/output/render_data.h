/* SPDX-License-Identifier: Apache-2.0 */
/* What a picture needs from a frame file (VTKHDF, written by output/frame.h). */
#ifndef TALUS_RENDER_DATA_H
#define TALUS_RENDER_DATA_H

#include "talus/status.h"

#include <stddef.h>

struct render_data {
    size_t count;              /* particles */
    double *positions;         /* [3 * count] m */
    double *values;            /* [count] what colours them; NULL: nothing */
    double *volumes;           /* [count] m^3 (per metre, per m^2); NULL: not in the frame */
    double *gradients;         /* [9 * count] F, row-major; NULL: not in the frame */
    double time;               /* [s] */
    char label[128], unit[32]; /* of the values */
};

/* Reads positions only. Release the data in any case. TALUS_INVALID (/frame) if there is no such
 * file, TALUS_IO if it is not a frame, TALUS_MEMORY. */
TALUS_MUST_CHECK enum talus_status
render_data_read_positions(struct render_data *data, const char *path, struct talus_error *error);

/* The same with everything else; `field` as in struct render_request. TALUS_INVALID (/field) for a
 * field or suffix that the frame does not have. */
TALUS_MUST_CHECK enum talus_status render_data_read(struct render_data *data, const char *path,
                                                    const char *field, struct talus_error *error);
void render_data_release(struct render_data *data);

#endif

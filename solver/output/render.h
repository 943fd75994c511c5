/* SPDX-License-Identifier: Apache-2.0 */
/* Draws a frame of a job as a PNG: particles coloured by a field, boundaries, axes in metres, a
 * colour bar with the unit, title and time.
 *
 * 2D scenes are drawn in their plane; solid ones in an orthographic view from above, with depth
 * and shading. The view depends on the first frame and the frame drawn, in coarse steps, so that
 * the frames of a run look alike. */
#ifndef TALUS_RENDER_H
#define TALUS_RENDER_H

#include "talus/status.h"

#include <stdint.h>

enum render_style {
    RENDER_POINTS, /* discs (2D) or spheres of the particle's size */
    RENDER_VOXELS, /* squares or cubes of the particle's volume, deformed by F where the frame has
                      it */
};

enum { RENDER_WIDTH_MIN = 160, RENDER_WIDTH_MAX = 4096 };

struct render_request {
    const char *folder; /* of the job: scene.json and frames/ */
    uint64_t frame;     /* number of the frame */
    /* What colours the particles: the name of a field in the frame, with an optional suffix:
     * vectors .x .y .z .magnitude (default); symmetric tensors .xx ... .xz .mean .norm .von_mises
     * (default: sqrt(3/2) of the norm of the deviator); gradients .xx .xy ... .zz .det (default).
     * NULL: velocity where the frame has it, else its first field. */
    const char *field;
    enum render_style style;
    int width;          /* [pixels] the height follows from what is drawn */
    const char *output; /* path of the PNG; written aside and renamed */
};

/* The style of that name ("points", "voxels"). TALUS_INVALID with the pointer /style. */
TALUS_MUST_CHECK enum talus_status render_find_style(const char *name, enum render_style *style,
                                                     struct talus_error *error);

/* Draws one picture. TALUS_INVALID for a frame (/frame), field (/field) or width (/width) that does
 * not exist, TALUS_IO for files that cannot be read or written, TALUS_MEMORY. */
TALUS_MUST_CHECK enum talus_status render_frame(const struct render_request *request,
                                                struct talus_error *error);

#endif

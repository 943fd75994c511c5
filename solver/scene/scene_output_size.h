/* SPDX-License-Identifier: Apache-2.0 */
/* What a run will write, out of its scene. */
#ifndef TALUS_SCENE_OUTPUT_SIZE_H
#define TALUS_SCENE_OUTPUT_SIZE_H

#include "talus/simulation.h"

struct scene_output_size {
    double frame_count;
    double frame_numbers;    /* of the particles of one frame, positions included */
    double row_count;        /* of the history, t = 0 included */
    double column_count;     /* of a row: time, energies, probes, reactions */
    double checkpoint_bytes; /* one restart point */
    double frame_bytes;      /* all frames of particles, without compression */
    double history_bytes;    /* the history in all files that hold it, at most */
    /* The folder of the finished run [bytes]: frames are compressed, so its size depends on how
     * regular the fields are; `high` is without any gain. */
    double low, expected, high;
};

struct scene_output_size scene_output_size(const struct talus_scene *scene,
                                           const struct talus_estimate *estimate);

#endif

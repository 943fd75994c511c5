/* SPDX-License-Identifier: Apache-2.0 */
/* checkpoint.h5: /state (JSON text of the run: counters, accumulators, frames so far) and one
 * dataset of bytes per blob of the simulation under /blobs, in the order of their index. */
#ifndef TALUS_CHECKPOINT_FILE_H
#define TALUS_CHECKPOINT_FILE_H

#include "talus/simulation.h"

/* Replaces the checkpoint at once. */
TALUS_MUST_CHECK enum talus_status checkpoint_write(const char *path, const char *state,
                                                    const struct talus_blob *blobs,
                                                    size_t blob_count, struct talus_error *error);

/* A checkpoint read back; owns everything. */
struct checkpoint {
    char *state;
    struct talus_blob *blobs;
    void **memory; /* [blob_count] what the blobs point to */
    size_t blob_count;
};
TALUS_MUST_CHECK enum talus_status checkpoint_read(struct checkpoint *checkpoint, const char *path,
                                                   struct talus_error *error);
void checkpoint_release(struct checkpoint *checkpoint);

#endif

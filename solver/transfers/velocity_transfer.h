/* SPDX-License-Identifier: Apache-2.0 */
/* The seam for transfers: how velocities go between particles and nodes. One file per transfer, one
 * line in transfers.def.
 *
 * A particle takes the share 1 - s of its own velocity with the nodes' increment (FLIP), and s of
 * the nodes' velocity (PIC). What a transfer wants beyond that it asks of the kernels of the
 * shape. */
#ifndef TALUS_VELOCITY_TRANSFER_H
#define TALUS_VELOCITY_TRANSFER_H

#include "talus/scene.h"

#include <stdbool.h>
#include <stddef.h>

struct transfer {
    const char *name, *reference, *summary;
    bool affine; /* particles carry the slope of their velocity: PARTICLE_AFFINE, GATHER_AFFINE */
    /* s, 0 ... 1, of a step of that length [s]. */
    double (*pic_share)(const struct talus_solver_options *options, double time_step);
};

extern const struct transfer *const transfer_table[];
extern const size_t transfer_count;

/* The transfer of a scene. */
static inline const struct transfer *transfer_of(const struct talus_solver_options *options)
{
    return transfer_table[options->transfer_index];
}

/* True if particles ever take the nodes' velocity itself. */
bool transfer_blends(const struct talus_solver_options *options);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Where the stages of a block hand over to each other: arrays of one thread, small enough to stay
 * in the first-level cache. Slot i belongs to slot i of the block (row * LANE_COUNT + lane). */
#ifndef TALUS_SCRATCH_H
#define TALUS_SCRATCH_H

#include <stddef.h>

enum { SCRATCH_HISTORY_MAX = 16 };

struct stage_clock; /* explicit/stage_clock.h */

struct block_scratch {
    struct stage_clock *clock; /* of the thread, the caller's; NULL: off */
    size_t capacity;           /* slots */
    size_t bad_slot; /* where the last block had a det f <= 0, or NAN; kinematics sets it then */
    void *memory;    /* owned; every array below lies in it, aligned to 64 bytes */
    /* gather writes */
    double *gradient[9]; /* L_ab = dv_a/dx_b at 3 a + b [1/s] */
    double *velocity[3]; /* grid velocity at the particle [m/s] */
    /* kinematics writes */
    double *stored[6];        /* trial strain in the stored form (e, or small strain, or ln J) */
    double *strain[6];        /* trial, then elastic strain for the material */
    double *rate[6];          /* d = sym L [1/s] */
    double *spin[3];          /* (L - L^T)/2: xy, yz, xz [1/s]; zero beyond the dimension */
    double *volume_ratio;     /* J */
    double *reference_volume; /* V0 [m^3]; 0 in empty slots */
    double *weight;           /* averaging weight: mass, 0 in empty slots [kg] */
    double *divergence;       /* tr d, cell-averaged where the strain is [1/s] */
    /* the material writes */
    double *stress[6];
    double *plastic_strain;
    double *dissipation;
    double *history[SCRATCH_HISTORY_MAX];
    /* move writes, scatter reads */
    double *force_stress[6]; /* V0 x Kirchhoff stress, with bulk damping [J] */
    double *mass;            /* [kg]; 0 where the particle has left its cell */
    /* a second set for compacting one material out of a mixed block */
    double *compact_strain[6], *compact_rate[6], *compact_spin[3], *compact_stress[6];
    double *compact_history[SCRATCH_HISTORY_MAX];
    double *compact_volume_ratio, *compact_plastic_strain, *compact_dissipation;
};

/* Makes room for that many slots; contents are lost. 0, or -1 when memory ran out. */
int block_scratch_reserve(struct block_scratch *scratch, size_t slots);
void block_scratch_release(struct block_scratch *scratch);

#endif

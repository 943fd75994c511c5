/* SPDX-License-Identifier: Apache-2.0 */
/* Where the stages of a block hand over to each other: arrays of one thread, small enough to stay
 * in the first-level cache. Slot i belongs to slot i of the block (row * LANE_COUNT + lane). */
#ifndef TALUS_SCRATCH_H
#define TALUS_SCRATCH_H

#include "base/inline.h"
#include "math/real.h"

#include <stddef.h>
#include <stdint.h>

enum { SCRATCH_HISTORY_MAX = 16 };
enum { GRADIENT_ZZ = 8 }; /* of the increments g */

struct stage_clock; /* explicit/stage_clock.h */

/* Memory that will be needed soon: fetched in small portions between the stages, since a core
 * waits when it asks for more cache lines than it can have on their way. */
struct fetch_ahead {
    const char *next, *end; /* of the particles of a later block */
};

struct block_scratch {
    struct fetch_ahead ahead;
    struct stage_clock *clock; /* of the thread, the caller's; NULL: off */
    size_t capacity;           /* slots */
    uint64_t materials; /* bit set: with particles in the block; the material stage sets it */
    size_t bad_slot;    /* where the last block had a det f <= 0, or NAN; kinematics sets it then */
    void *memory;       /* owned; every array below lies in it, aligned to 64 bytes */
    /* gather writes */
    real *gradient[9];     /* g_ab = dt dv_a/dx_b at 3 a + b [1]; free once the material runs */
    real *displacement[3]; /* of the step, in cell widths */
    /* kinematics writes */
    real *strain[6];        /* trial, then elastic strain for the material */
    real *rate[6];          /* d = sym L [1/s], if a material or the damping wants it */
    real *spin[3];          /* (L - L^T)/2: xy, yz, xz [1/s]; zero beyond the dimension */
    real *volume_ratio;     /* J, if a material wants rates */
    real *volume_increment; /* det(1 + g) - 1 */
    real *reference_volume; /* V0 [m^3]; 0 in empty slots, and once a particle has left its cell */
    /* the material writes */
    real *stress[6];
    real *plastic_strain;
    real *dissipation;
    real *history[SCRATCH_HISTORY_MAX];
    /* move writes where particles leave their cells */
    real *mass; /* [kg]; 0 where the particle has left its cell */
    /* the damping writes, scatter reads */
    real *damped_stress[3]; /* diagonal of stress with bulk damping [Pa] */
    /* anti-locking, and compacting one material out of a mixed block */
    real *weight, *mean;
    real *fit[6], *product, *coordinate[3]; /* fits over nodes */
    real *compact_strain[6], *compact_rate[6], *compact_spin[3], *compact_stress[6];
    real *compact_history[SCRATCH_HISTORY_MAX];
    real *compact_volume_ratio, *compact_plastic_strain, *compact_dissipation;
};

/* Asks for the next portion of what `ahead` still holds, into the second-level cache: the first has
 * too few places for misses on their way. */
TALUS_INLINE void fetch_portion(struct fetch_ahead *ahead)
{
    enum { LINE = 64, PORTION = 12 };
    const char *next = ahead->next;
    for (int line = 0; line < PORTION && next < ahead->end; line++, next += LINE)
        __builtin_prefetch(next, 0, 2);
    ahead->next = next;
}

TALUS_INLINE void fetch_rest(struct fetch_ahead *ahead)
{
    while (ahead->next < ahead->end)
        fetch_portion(ahead);
}

/* Makes room for that many slots; contents are lost. 0, or -1 when memory ran out. */
int block_scratch_reserve(struct block_scratch *scratch, size_t slots);
void block_scratch_release(struct block_scratch *scratch);
/* Bytes of all arrays with that many slots of `number` bytes each. */
size_t block_scratch_bytes(size_t slots, size_t number);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Principal values and axes for the models that return in principal space: those slots of a chunk
 * that may flow are put side by side, so that the rest costs them nothing. */
#ifndef TALUS_PRINCIPAL_H
#define TALUS_PRINCIPAL_H

#include "materials/elasticity.h"

struct principal {               /* arrays over the places of what has been gathered */
    size_t count;                /* places; whole rows */
    size_t used;                 /* of which hold a slot; the rest is zero */
    size_t slot[MATERIAL_CHUNK]; /* slot of the batch */
    MATERIAL_ALIGNED real strain[SYM3_COMPONENTS][MATERIAL_CHUNK]; /* trial elastic strain */
    MATERIAL_ALIGNED real stress[3][MATERIAL_CHUNK];   /* principal trial stress, falling [Pa] */
    MATERIAL_ALIGNED real axis[3][3][MATERIAL_CHUNK];  /* component [1] of the axis of stress [0] */
    MATERIAL_ALIGNED real returned[3][MATERIAL_CHUNK]; /* principal stress after the return [Pa] */
};

/* Largest and smallest principal trial stress of each slot of a chunk: `high`, `low` [count], and
 * the bound `doubt` of their error, which is large where values repeat [Pa]. */
void principal_extremes(struct stiffness stiffness, const struct material_batch *batch,
                        size_t begin, size_t count, real *high, real *low, real *doubt);

/* Fills slot, strain, stress and axis with those slots of a chunk that `chosen` [count] marks by a
 * positive number. */
void principal_gather(struct stiffness stiffness, const struct material_batch *batch, size_t begin,
                      size_t count, const real *chosen, struct principal *principal);

/* What the return did to each place. */
struct principal_flow {
    MATERIAL_ALIGNED real norm[MATERIAL_CHUNK];        /* |plastic strain increment| */
    MATERIAL_ALIGNED real shear[MATERIAL_CHUNK];       /* its largest minus its smallest value */
    MATERIAL_ALIGNED real dissipation[MATERIAL_CHUNK]; /* returned stress on it [J/m^3] */
};

/* Writes strain, stress, plastic strain and dissipation of the slots whose stress changed; the
 * others of the batch keep what they have. principal->strain holds the elastic strains then. */
void principal_scatter(struct stiffness stiffness, struct principal *principal,
                       const struct material_batch *batch, struct principal_flow *flow);

#endif

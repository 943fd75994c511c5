/* SPDX-License-Identifier: Apache-2.0 */
/* Return to the planes of Mohr and Coulomb in principal space, tension positive, s1 >= s2 >= s3
 * (Clausen, Damkilde and Andersen 2006; Andersen and Andersen 2012, eq. 45-48):
 *
 *   shear    k s1 - s3 <= strength      flow (m, 0, -1)
 *   tension  s1 <= limit                flow (1, 0, 0)
 *
 * with k = (1 + sin phi)/(1 - sin phi), m the same of the dilation angle, m <= k, and a limit no
 * further than the apex strength/(k - 1). Exact for strengths that do not change in the step: a few
 * closed forms, one of which holds for each trial (multi_surface.c), no iteration. */
#ifndef TALUS_MULTI_SURFACE_H
#define TALUS_MULTI_SURFACE_H

#include "materials/principal.h"

struct surfaces {                                   /* in force over the slots of a chunk */
    MATERIAL_ALIGNED real slope[MATERIAL_CHUNK];    /* k, at least 1 */
    MATERIAL_ALIGNED real flow[MATERIAL_CHUNK];     /* m, 1 ... k */
    MATERIAL_ALIGNED real strength[MATERIAL_CHUNK]; /* 2 c sqrt(k) [Pa] */
    MATERIAL_ALIGNED real limit[MATERIAL_CHUNK];    /* largest tension [Pa]; may be INFINITY */
};

/* What a model with these surfaces adds: the surfaces at the start of the step of slots
 * begin ... begin + count - 1, out of `shear`, the history variable below, at those slots. */
typedef void surfaces_at_start(const void *model, const real *shear, size_t count,
                               struct surfaces *surfaces);

/* Stress, strain, plastic strain and dissipation of a batch. `shear` [batch->count] is the history
 * variable of softening, the sum of the largest minus the smallest principal value of the plastic
 * strain increments (in simple shear: the plastic part of the angle gamma). Returns whether a slot
 * flowed. */
bool multi_surface_update(const struct elasticity *elasticity, const struct material_batch *batch,
                          surfaces_at_start *surfaces_of, const void *model, real *shear);

#endif

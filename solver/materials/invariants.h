/* SPDX-License-Identifier: Apache-2.0 */
/* Returns that act on the invariants of the trial stress only: they scale its deviator and shift
 * its trace, so no eigenvectors are needed. A chunk of slots passes through three loops: trial
 * invariants, the model's own return, and the application to strain and stress. Short loops in a
 * row are faster than one long loop, which waits for its own square roots and divisions. */
#ifndef TALUS_INVARIANTS_H
#define TALUS_INVARIANTS_H

#include "materials/elasticity.h"

struct invariants { /* arrays over the slots of a chunk; slots that stay elastic come out with their
                       trial I1, scale 1 (0 without a deviator) and spherical 0 */
    MATERIAL_ALIGNED real first[MATERIAL_CHUNK]; /* in: I1 = tr(sigma) of the trial stress [Pa] */
    MATERIAL_ALIGNED real norm[MATERIAL_CHUNK];  /* in: |s| of the trial stress [Pa] */
    MATERIAL_ALIGNED real
        determinant[MATERIAL_CHUNK]; /* in, on request: det(s) of the trial stress [Pa^3] */
    MATERIAL_ALIGNED real returned[MATERIAL_CHUNK]; /* out: I1 returned [Pa] */
    MATERIAL_ALIGNED real scale[MATERIAL_CHUNK];    /* out: |s| returned / |s| trial */
    MATERIAL_ALIGNED real
        spherical[MATERIAL_CHUNK]; /* out: a third of the trace of the plastic strain increment */
};

/* Everything that is `in`, for slots begin ... begin + count - 1. */
TALUS_INLINE void invariants_of_trial(struct stiffness stiffness,
                                      const struct material_batch *batch, size_t components,
                                      size_t begin, size_t count, bool with_determinant,
                                      struct invariants *invariants)
{
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        struct sym3 strain = components_load(batch->strain, begin + index, components);
        struct sym3 deviator = sym3_scale(stiffness.shear, sym3_deviator(strain));
        invariants->first[index] = stiffness.bulk * sym3_trace(strain);
        invariants->norm[index] = sym3_norm(deviator);
        if (with_determinant)
            invariants->determinant[index] = sym3_determinant(deviator);
    }
}

/* Elastic strain and stress from everything that is `out`. Slots that stayed elastic keep their
 * strain to the last bit. */
TALUS_INLINE void invariants_apply(struct stiffness stiffness, const struct material_batch *batch,
                                   size_t components, size_t begin, size_t count,
                                   const struct invariants *invariants)
{
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        size_t slot = begin + index;
        real scale = invariants->scale[index];
        real mean = invariants->returned[index] * (real)(1.0 / 3.0);
        struct sym3 strain = components_load(batch->strain, slot, components);
        struct sym3 deviator = sym3_deviator(strain);
        strain = sym3_add_scaled(strain, scale - 1, deviator);
        components_store(batch->strain, slot, components,
                         sym3_add_diagonal(strain, -invariants->spherical[index]));
        components_store(batch->stress, slot, components,
                         sym3_add_diagonal(sym3_scale(stiffness.shear * scale, deviator), mean));
    }
}

/* Norm of a plastic strain increment: |dev|, and a third of its trace. */
TALUS_INLINE real flow_norm(real deviatoric, real spherical)
{
    return real_sqrt(deviatoric * deviatoric + 3 * spherical * spherical);
}

/* Energy that a flow takes from a stress with |s| = norm and I1 = first; negative by round-off
 * only. */
TALUS_INLINE real flow_dissipation(real norm, real first, real deviatoric, real spherical)
{
    return maximum(norm * deviatoric + first * spherical, 0);
}

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Returns that act on the invariants of the trial stress only: they scale its deviator and shift
 * its trace, so no eigenvectors are needed. A chunk of slots passes through three loops: trial
 * invariants, the model's own return, and the application to strain and stress. */
#ifndef TALUS_INVARIANTS_H
#define TALUS_INVARIANTS_H

#include "materials/elasticity.h"

struct invariants {               /* arrays over the slots of a chunk */
    double first[MATERIAL_CHUNK]; /* I1 = tr(sigma) [Pa]: in trial, out returned */
    double norm[MATERIAL_CHUNK];  /* |s| of the trial stress [Pa] */
    double third[MATERIAL_CHUNK]; /* det(s)/|s|^3 of the trial stress [-]; 0 where |s| = 0 */
    double scale[MATERIAL_CHUNK]; /* out: |s| returned / |s| trial; 1 where elastic */
    double trial[MATERIAL_CHUNK]; /* I1 of the trial stress [Pa] */
};

/* Fills everything but `scale` for slots begin ... begin + count - 1; `third` on request. */
TALUS_INLINE void invariants_of_trial(const struct elasticity *elasticity,
                                      const struct material_batch *batch, size_t components,
                                      size_t begin, size_t count, bool with_third,
                                      struct invariants *invariants)
{
    double bulk = elasticity->bulk;
    double shear = elasticity->shear;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        struct sym3 strain = components_load(batch->strain, begin + index, components);
        double volumetric = sym3_trace(strain);
        struct sym3 deviator = sym3_add_diagonal(strain, -volumetric / 3.0);
        double norm = sym3_norm(deviator);
        invariants->first[index] = 3.0 * bulk * volumetric;
        invariants->trial[index] = 3.0 * bulk * volumetric;
        invariants->norm[index] = 2.0 * shear * norm;
        if (with_third) {
            /* |det s| <= |s|^3 / sqrt(54); the bound holds round-off of tiny strains off */
            double inverse = norm > 0.0 ? 1.0 / norm : 0.0;
            double third = sym3_determinant(sym3_scale(inverse, deviator));
            const double bound = 0.13608276348795434;
            third = minimum(maximum(third, -bound), bound);
            invariants->third[index] = third;
        }
    }
}

/* Elastic strain, stress, plastic strain and dissipation from the returned invariants. Slots that
 * stayed elastic (scale 1, first = trial) keep their strain to the last bit. */
TALUS_INLINE void invariants_apply(const struct elasticity *elasticity,
                                   const struct material_batch *batch, size_t components,
                                   size_t begin, size_t count, const struct invariants *invariants)
{
    double bulk = elasticity->bulk;
    double shear = elasticity->shear;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        size_t slot = begin + index;
        double first = invariants->first[index];
        double scale = invariants->scale[index];
        double norm = invariants->norm[index];
        struct sym3 strain = components_load(batch->strain, slot, components);
        struct sym3 deviator = sym3_deviator(strain);
        struct sym3 stress =
            sym3_add_diagonal(sym3_scale(2.0 * shear * scale, deviator), first / 3.0);
        double spherical = (invariants->trial[index] - first) / (9.0 * bulk); /* of the increment */
        double deviatoric = (1.0 - scale) * norm / (2.0 * shear);
        strain = sym3_add_diagonal(sym3_add_scaled(strain, scale - 1.0, deviator), -spherical);
        components_store(batch->strain, slot, components, strain);
        components_store(batch->stress, slot, components, stress);
        batch->plastic_strain[slot] = sqrt(deviatoric * deviatoric + 3.0 * spherical * spherical);
        /* sigma : plastic strain increment; never negative but for round-off */
        batch->dissipation[slot] = maximum(scale * norm * deviatoric + first * spherical, 0.0);
    }
}

#endif

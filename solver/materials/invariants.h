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
    MATERIAL_ALIGNED real
        sine[MATERIAL_CHUNK]; /* in, on request: sin(3 theta) of the trial's Lode angle, where
                                 cos(3 theta) = 3 sqrt(6) det(s)/|s|^3; 0 without a deviator */
    MATERIAL_ALIGNED real returned[MATERIAL_CHUNK]; /* out: I1 returned [Pa] */
    MATERIAL_ALIGNED real scale[MATERIAL_CHUNK];    /* out: |s| returned / |s| trial */
    MATERIAL_ALIGNED real
        spherical[MATERIAL_CHUNK]; /* out: a third of the trace of the plastic strain increment */
    MATERIAL_ALIGNED real
        quadratic[MATERIAL_CHUNK]; /* out, with `sine`: the deviator returned is scale s +
                                      quadratic dev(s^2)/(2 G) of the trial's s, which turns it */
};

/* What a model asks for; each holds those before it. */
enum invariants_kind {
    INVARIANTS_OF_SCALING,   /* first, norm; the deviator returned has the trial's direction */
    INVARIANTS_OF_DIRECTION, /* also the determinant */
    INVARIANTS_OF_TURNING,   /* also the sine; the deviator returned may have another Lode angle */
};

/* sin(3 theta) of a deviator, from the part of its square that is across it: exact to the last
 * digits near triaxial states, where sqrt(1 - cos^2) is not. */
TALUS_INLINE real lode_sine(struct sym3 deviator)
{
    real norm = sym3_norm(deviator);
    struct sym3 unit = sym3_scale(1 / (norm > 0 ? norm : 1), deviator);
    struct sym3 square = sym3_deviator(sym3_square(unit));
    struct sym3 across = sym3_add_scaled(square, -3 * sym3_determinant(unit), unit);
    return (real)2.449489742783178 * sym3_norm(across); /* sqrt(6) */
}

/* Everything that is `in`, for slots begin ... begin + count - 1. */
TALUS_INLINE void invariants_of_trial(struct stiffness stiffness,
                                      const struct material_batch *batch, size_t components,
                                      size_t begin, size_t count, enum invariants_kind kind,
                                      struct invariants *invariants)
{
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        struct sym3 strain = components_load(batch->strain, begin + index, components);
        struct sym3 deviator = sym3_scale(stiffness.shear, sym3_deviator(strain));
        invariants->first[index] = stiffness.bulk * sym3_trace(strain);
        invariants->norm[index] = sym3_norm(deviator);
        if (kind >= INVARIANTS_OF_DIRECTION)
            invariants->determinant[index] = sym3_determinant(deviator);
        if (kind >= INVARIANTS_OF_TURNING)
            invariants->sine[index] = lode_sine(deviator);
    }
}

/* Elastic strain and stress from everything that is `out`. Slots that stayed elastic keep their
 * strain to the last bit. */
TALUS_INLINE void invariants_apply(struct stiffness stiffness, const struct material_batch *batch,
                                   size_t components, size_t begin, size_t count,
                                   enum invariants_kind kind, const struct invariants *invariants)
{
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        size_t slot = begin + index;
        real scale = invariants->scale[index];
        real mean = invariants->returned[index] * (real)(1.0 / 3.0);
        struct sym3 strain = components_load(batch->strain, slot, components);
        struct sym3 deviator = sym3_deviator(strain);
        struct sym3 stress = sym3_scale(stiffness.shear * scale, deviator);
        strain = sym3_add_scaled(strain, scale - 1, deviator);
        if (kind >= INVARIANTS_OF_TURNING) {
            struct sym3 turned =
                sym3_scale(invariants->quadratic[index], sym3_deviator(sym3_square(deviator)));
            strain = sym3_add(strain, turned);
            stress = sym3_add_scaled(stress, stiffness.shear, turned);
        }
        components_store(batch->strain, slot, components,
                         sym3_add_diagonal(strain, -invariants->spherical[index]));
        components_store(batch->stress, slot, components, sym3_add_diagonal(stress, mean));
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

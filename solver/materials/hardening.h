/* SPDX-License-Identifier: Apache-2.0 */
/* Linear isotropic and kinematic hardening, which J2 and the Drucker-Prager cone share (Mast 2013,
 * eq. 3.69-3.83):
 *
 *   eta = s - 2/3 H a_kin          yield stress sigma_Y + k a_iso, times sqrt(2/3) for norms
 *
 * a_kin grows by the deviatoric plastic strain, which is along eta, a_iso by sqrt(2/3) of its norm
 * (as his 3.82 needs and 3.74 misprints). At finite strain the back strain turns with the material,
 * or a stressed body that spins would harden; the source, which returns in principal space, leaves
 * that open. */
#ifndef TALUS_HARDENING_H
#define TALUS_HARDENING_H

#include "materials/elasticity.h"

struct hardening {
    double isotropic; /* k [Pa] */
    double kinematic; /* H [Pa] */
};

/* What the constants of a model with hardening begin with. */
struct hardening_solid {
    struct elasticity elasticity;
    struct hardening hardening;
};
ELASTICITY_COMES_FIRST(struct hardening_solid);

enum hardening_state {
    HARDENING_ISOTROPIC,
    HARDENING_BACK_STRAIN,
    HARDENING_STATE_COUNT = HARDENING_BACK_STRAIN + SYM3_COMPONENTS
};
extern const char *const hardening_state_names[HARDENING_STATE_COUNT];

/* Out of checked values, where the constants of hardening stand at `first`. */
struct hardening_solid hardening_solid_read(const double *values, size_t first);
/* Entries of struct material for models whose constants begin with a struct hardening_solid.
 * True: there is kinematic hardening. */
bool hardening_needs_spin(const void *constants);
/* Elastic
 * energy and that of the back strain, H/3 |a_kin|^2, which a reversed load recovers. */
void hardening_strain_energy(const void *constants, const struct material_batch *batch,
                             real *energy);

struct hardening_law { /* what the loops compute with */
    struct stiffness stiffness;
    real back;      /* 2/3 H: back stress over back strain [Pa] */
    real growth;    /* sqrt(2/3) k: what a_iso adds to the strength [Pa] */
    real shear;     /* 2 G + 2/3 H: fall of |eta| over the multiplier [Pa] */
    real isotropic; /* 2/3 k: growth of the strength over the multiplier [Pa] */
};

static inline struct hardening_law hardening_law_of(const struct hardening_solid *solid)
{
    const struct elasticity *elasticity = &solid->elasticity;
    const struct hardening *hardening = &solid->hardening;
    const double back = 2.0 / 3.0 * hardening->kinematic;
    return (struct hardening_law){
        .stiffness = elasticity_stiffness(elasticity),
        .back = (real)back,
        .growth = (real)(sqrt(2.0 / 3.0) * hardening->isotropic),
        .shear = (real)(2.0 * elasticity->shear + back),
        .isotropic = (real)(2.0 / 3.0 * hardening->isotropic),
    };
}

#define HARDENING_ROOT                                                                             \
    ((real)0.816496580927726) /* sqrt(2/3): growth of a_iso over the multiplier */

/* The rotation of a step: Cayley transform of the spin, orthogonal for any step (Hughes and Winget
 * 1980): 1 + s (W + W^2 / 2) with s = 1/(1 + |w|^2 / 4) and W^2 = w (x) w - |w|^2 1. */
TALUS_INLINE struct mat3 spin_rotation(real xy, real yz, real xz)
{
    const real half = (real)0.5;
    real square = xy * xy + yz * yz + xz * xz;
    real scale = 1 / (1 + (real)0.25 * square);
    real diagonal = 1 - half * scale * square;
    real x = scale * yz; /* W v = v x w of the vector w = (yz, -xz, xy) */
    real y = -scale * xz;
    real z = scale * xy;
    return (struct mat3){{
        {diagonal + half * x * yz, z - half * x * xz, half * x * xy - y},
        {-half * x * xz - z, diagonal - half * y * xz, x + half * y * xy},
        {half * x * xy + y, half * y * xy - x, diagonal + half * z * xy},
    }};
}

/* Turns the back strain with the material: it is zero before the first flow, which leaves its mark
 * in the isotropic variable.
 */
TALUS_INLINE void hardening_turn(const struct material_batch *batch, size_t components)
{
    real *const *back = batch->history + HARDENING_BACK_STRAIN;
    const real time_step = (real)batch->time_step;
    const size_t count = slot_count(batch);
    if (!number_bits(count, batch->history[HARDENING_ISOTROPIC]).nonzero)
        return;
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        real xy = time_step * batch->spin[0][slot];
        real yz = components > 4 ? time_step * batch->spin[1][slot] : 0;
        real xz = components > 4 ? time_step * batch->spin[2][slot] : 0;
        struct sym3 turned =
            sym3_push_forward(spin_rotation(xy, yz, xz), components_load(back, slot, components));
        components_store(back, slot, components, turned);
    }
}

/* eta; `kinematic` is known to the compiler and spares the back strain where H is 0. */
TALUS_INLINE struct sym3 relative_stress(const struct hardening_law *law, struct sym3 strain,
                                         struct sym3 back_strain, bool kinematic)
{
    struct sym3 stress = sym3_scale(law->stiffness.shear, sym3_deviator(strain));
    return kinematic ? sym3_add_scaled(stress, -law->back, back_strain) : stress;
}

TALUS_INLINE struct sym3 back_strain_load(const struct material_batch *batch, size_t slot,
                                          size_t components, bool kinematic)
{
    return kinematic ? components_load(batch->history + HARDENING_BACK_STRAIN, slot, components)
                     : (struct sym3){0};
}

struct hardening_flow { /* arrays over the slots of a chunk; those with spherical flow only count
                           for models that have it */
    MATERIAL_ALIGNED real along[MATERIAL_CHUNK];     /* in: |eta| of the trial [Pa]; out: deviatoric
                                                        plastic strain over |eta| [1/Pa] */
    MATERIAL_ALIGNED real spherical[MATERIAL_CHUNK]; /* in: I1 of the trial [Pa]; out: a third of
                                                        the trace of the plastic strain increment */
};

/* What a model adds: the return of slots begin ... begin + count - 1 along eta and the trace.
 * Writes the `out` of the flow, plastic strain, dissipation and the isotropic variable. */
typedef void hardening_return(const void *law, const struct material_batch *batch, size_t begin,
                              size_t count, struct hardening_flow *flow);

TALUS_INLINE void hardening_trial(const struct hardening_law *constants,
                                  const struct material_batch *batch, size_t components,
                                  bool kinematic, bool spherical, size_t begin, size_t count,
                                  struct hardening_flow *flow)
{
    const struct hardening_law law = *constants;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        size_t slot = begin + index;
        struct sym3 strain = components_load(batch->strain, slot, components);
        struct sym3 back_strain = back_strain_load(batch, slot, components, kinematic);
        flow->along[index] = sym3_norm(relative_stress(&law, strain, back_strain, kinematic));
        if (spherical)
            flow->spherical[index] = law.stiffness.bulk * sym3_trace(strain);
    }
}

TALUS_INLINE void hardening_apply(const struct hardening_law *constants,
                                  const struct material_batch *batch, size_t components,
                                  bool kinematic, bool spherical, size_t begin, size_t count,
                                  const struct hardening_flow *flow)
{
    const struct hardening_law law = *constants;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        size_t slot = begin + index;
        real along = flow->along[index];
        struct sym3 strain = components_load(batch->strain, slot, components);
        struct sym3 back_strain = back_strain_load(batch, slot, components, kinematic);
        struct sym3 relative = relative_stress(&law, strain, back_strain, kinematic);
        strain = sym3_add_scaled(strain, -along, relative);
        if (spherical)
            strain = sym3_add_diagonal(strain, -flow->spherical[index]);
        components_store(batch->strain, slot, components, strain);
        components_store(batch->stress, slot, components, elasticity_stress(law.stiffness, strain));
        if (kinematic)
            components_store(batch->history + HARDENING_BACK_STRAIN, slot, components,
                             sym3_add_scaled(back_strain, along, relative));
    }
}

TALUS_INLINE bool hardening_update_kernel(const struct hardening_law *constants,
                                          hardening_return *model, const void *model_law,
                                          const struct material_batch *batch, size_t components,
                                          bool kinematic, bool spherical)
{
    const struct hardening_law law = *constants;
    const size_t slots = slot_count(batch);
    struct hardening_flow flow;
    bool flowed = false;
    if (kinematic && batch->spin[0] != NULL)
        hardening_turn(batch, components);
    for (size_t begin = 0; begin < slots; begin += MATERIAL_CHUNK) {
        const size_t count = chunk_count(slots, begin);
        hardening_trial(&law, batch, components, kinematic, spherical, begin, count, &flow);
        model(model_law, batch, begin, count, &flow);
        if (any_flowed(batch, begin, count)) {
            hardening_apply(&law, batch, components, kinematic, spherical, begin, count, &flow);
            flowed = true;
        } else {
            elasticity_apply(law.stiffness, batch, components, begin, count);
        }
    }
    return flowed;
}

/* The update of a model with that return; `spherical`: it has flow along the trace. */
TALUS_INLINE bool hardening_update(const struct hardening_law *law, hardening_return *model,
                                   const void *model_law, const struct material_batch *batch,
                                   size_t components, bool spherical)
{
    if (law->back > 0)
        return hardening_update_kernel(law, model, model_law, batch, components, true, spherical);
    return hardening_update_kernel(law, model, model_law, batch, components, false, spherical);
}

#endif

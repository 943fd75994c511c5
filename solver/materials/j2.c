/* SPDX-License-Identifier: Apache-2.0 */
/* J2 plasticity with linear isotropic and kinematic hardening, by the closed-form radial return
 * (Mast 2013, eq. 3.69-3.83): F = |eta| - sqrt(2/3) (sigma_Y + k a_iso). */
#include "materials/hardening.h"

struct j2 {
    struct hardening_solid solid;
    double yield_stress; /* sigma_Y, uniaxial [Pa] */
};

enum value {
    VALUE_YIELD_STRESS = ELASTICITY_VALUE_COUNT,
    VALUE_ISOTROPIC_HARDENING, /* and the kinematic one */
};

static const struct parameter parameters[] = {
    {.key = "yield_stress",
     .symbol = "sigma_Y",
     .unit = "Pa",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .meaning = "uniaxial yield stress"},
#include "materials/hardening_parameters.def"
    {.key = NULL},
};

static void prepare(const double *values, void *constants)
{
    struct j2 *j2 = constants;
    *j2 = (struct j2){
        .solid = hardening_solid_read(values, VALUE_ISOTROPIC_HARDENING),
        .yield_stress = values[VALUE_YIELD_STRESS],
    };
}

struct j2_law {            /* what the return computes with */
    real initial_strength; /* sqrt(2/3) sigma_Y [Pa] */
    real growth, shear;    /* as in struct hardening_law */
    real inverse;          /* multiplier over what is beyond the surface [1/Pa] */
};

static void radial_return(const void *constants, const struct material_batch *batch, size_t begin,
                          size_t count, struct hardening_flow *flow)
{
    const struct j2_law law = *(const struct j2_law *)constants;
    real *isotropic = batch->history[HARDENING_ISOTROPIC] + begin;
    real *plastic_strain = batch->plastic_strain + begin;
    real *dissipation = batch->dissipation + begin;
    real *along = flow->along;
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real norm = along[index];
        real strength = law.initial_strength + law.growth * isotropic[index];
        real multiplier = maximum(norm - strength, 0) * law.inverse;
        along[index] = multiplier / (norm > 0 ? norm : 1);
        isotropic[index] += HARDENING_ROOT * multiplier;
        plastic_strain[index] = multiplier;
        /* what is not stored in the back strain is lost: |eta| dgam */
        dissipation[index] = (norm - law.shear * multiplier) * multiplier;
    }
}

TALUS_INLINE bool update_stress_kernel(const struct j2 *j2, const struct material_batch *batch,
                                       size_t components)
{
    const struct hardening_law hardening = hardening_law_of(&j2->solid);
    const struct j2_law law = {
        .initial_strength = (real)(sqrt(2.0 / 3.0) * j2->yield_stress),
        .growth = hardening.growth,
        .shear = hardening.shear,
        .inverse = 1 / (hardening.shear + hardening.isotropic),
    };
    return hardening_update(&hardening, radial_return, &law, batch, components, false);
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct j2 *j2 = constants;
    return MATERIAL_INSTANTIATE(update_stress_kernel, j2, batch);
}

const struct material j2 = {
    .name = "j2",
    .reference = "Mast 2013, eq. 3.69-3.83",
    .summary = "von Mises plasticity with linear isotropic and kinematic hardening",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
    .state_count = HARDENING_STATE_COUNT,
    .state_names = hardening_state_names,
    .constants_size = sizeof(struct j2),
    .check = elasticity_check_alone,
    .prepare = prepare,
    .wave_speed = elasticity_wave_speed,
    .needs_spin = hardening_needs_spin,
    .update_stress = update_stress,
    .strain_energy = hardening_strain_energy,
    .strain_from_stress = elasticity_strain_from_stress,
};

/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/hardening.h"

const char *const hardening_state_names[HARDENING_STATE_COUNT] = {
    "equivalent_plastic_strain",
    "back_strain_xx",
    "back_strain_yy",
    "back_strain_zz",
    "back_strain_xy",
    "back_strain_yz",
    "back_strain_xz",
};

TALUS_INLINE void add_back_strain_energy(const struct hardening *hardening,
                                         const struct material_batch *batch, size_t components,
                                         real *energy)
{
    real *const *back = batch->history + HARDENING_BACK_STRAIN;
    const real factor = (real)(hardening->kinematic / 3.0);
    const size_t count = slot_count(batch);
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        struct sym3 back_strain = components_load(back, slot, components);
        energy[slot] += factor * sym3_dot(back_strain, back_strain);
    }
}

struct hardening_solid hardening_solid_read(const double *values, size_t first)
{
    return (struct hardening_solid){
        .elasticity = elasticity_read(values),
        .hardening = {.isotropic = values[first], .kinematic = values[first + 1]},
    };
}

bool hardening_needs_spin(const void *constants)
{
    const struct hardening_solid *solid = constants;
    return solid->hardening.kinematic != 0.0;
}

void hardening_strain_energy(const void *constants, const struct material_batch *batch,
                             real *energy)
{
    const struct hardening_solid *solid = constants;
    const struct hardening *hardening = &solid->hardening;
    elasticity_strain_energy(constants, batch, energy);
    if (hardening->kinematic == 0.0)
        return;
    if (batch->component_count == 3)
        add_back_strain_energy(hardening, batch, 3, energy);
    else if (batch->component_count == 4)
        add_back_strain_energy(hardening, batch, 4, energy);
    else
        add_back_strain_energy(hardening, batch, 6, energy);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/mobilised.h"

static const struct parameter parameters[] = {
#include "materials/mobilised_parameters.def"
    {.key = NULL},
};

/* The outer cone, whatever the direction. */
static void surface_slopes(size_t count, const real *tangent, const struct invariants *invariants,
                           real *slope)
{
    (void)invariants;
    mobilised_cone_slopes(count, tangent, slope);
}

TALUS_INLINE bool update_stress_kernel(const struct mobilised *mobilised,
                                       const struct material_batch *batch, size_t components)
{
    return mobilised_update(mobilised, batch, components, surface_slopes, INVARIANTS_OF_SCALING,
                            NULL);
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct mobilised *mobilised = constants;
    return MATERIAL_INSTANTIATE(update_stress_kernel, mobilised, batch);
}

const struct material drucker_prager_mobilised = {
    .name = "drucker_prager_mobilised",
    .reference = "Mast 2013, sec. 3.6.3 and eq. 3.112-3.119",
    .summary = "Drucker-Prager cone whose friction and dilation follow from the plastic strain",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
    .state_count = MOBILISED_STATE_COUNT,
    .state_names = mobilised_state_names,
    .constants_size = sizeof(struct mobilised),
    .check = mobilised_check,
    .prepare = mobilised_prepare,
    .wave_speed = elasticity_wave_speed,
    .initialise = mobilised_initialise,
    .update_stress = update_stress,
    .strain_energy = elasticity_strain_energy,
    .strain_from_stress = elasticity_strain_from_stress,
    .initial_friction_angle_deg = mobilised_initial_friction_angle_deg,
};

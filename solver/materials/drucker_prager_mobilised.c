/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/mobilised.h"

static const struct parameter parameters[] = {
#include "materials/mobilised_parameters.def"
    {.key = NULL},
};

TALUS_INLINE void update_stress_kernel(const struct mobilised *mobilised,
                                       const struct material_batch *batch, size_t components)
{
    struct invariants invariants;
    struct mobilised_angles angles;
    for (size_t begin = 0; begin < batch->count; begin += MATERIAL_CHUNK) {
        size_t left = batch->count - begin;
        size_t count = left < MATERIAL_CHUNK ? left : MATERIAL_CHUNK;
        double slope[MATERIAL_CHUNK];
        double flow_slope[MATERIAL_CHUNK];
        mobilised_angles_at_start(mobilised, batch, begin, count, &angles);
        for (size_t index = 0; index < count; index++) {
            slope[index] = mobilised_cone_slope(angles.tangent[index]);
            flow_slope[index] = mobilised_cone_slope(angles.flow_tangent[index]);
        }
        invariants_of_trial(&mobilised->elasticity, batch, components, begin, count, false,
                            &invariants);
        mobilised_return(mobilised, count, slope, flow_slope, &invariants);
        invariants_apply(&mobilised->elasticity, batch, components, begin, count, &invariants);
        mobilised_advance(mobilised, batch, begin, count, &invariants);
    }
}

static void update_stress(const void *constants, const struct material_batch *batch)
{
    const struct mobilised *mobilised = constants;
    MATERIAL_INSTANTIATE(update_stress_kernel, mobilised, batch);
}

const struct material drucker_prager_mobilised = {
    .name = "drucker_prager_mobilised",
    .reference = "Mast 2013, sec. 3.6.3 and eq. 3.112-3.119",
    .summary = "Drucker-Prager cone whose friction and dilation follow from the plastic strain",
    .parameters = parameters,
    .plastic = true,
    .state_count = MOBILISED_STATE_COUNT,
    .state_names = mobilised_state_names,
    .constants_size = sizeof(struct mobilised),
    .check = mobilised_check,
    .prepare = mobilised_prepare,
    .wave_speed = mobilised_wave_speed,
    .initialise = mobilised_initialise,
    .update_stress = update_stress,
    .strain_energy = mobilised_strain_energy,
    .strain_from_stress = mobilised_strain_from_stress,
    .initial_friction_angle_deg = mobilised_initial_friction_angle_deg,
};

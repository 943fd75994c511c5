/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/elasticity.h"

static const struct parameter no_parameters[] = {{.key = NULL}};

TALUS_INLINE void update_stress_kernel(const struct elasticity *elasticity,
                                       const struct material_batch *batch, size_t components)
{
    elasticity_apply(elasticity_stiffness(elasticity), batch, components, 0, slot_count(batch));
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct elasticity *elasticity = constants;
    MATERIAL_INSTANTIATE(update_stress_kernel, elasticity, batch);
    return false;
}

const struct material linear_elastic = {
    .name = "linear_elastic",
    .reference = "Mast 2013, eq. 3.45 (with 2 G on the deviator)",
    .summary = "isotropic linear elasticity; at finite strain in Hencky strain",
    .parameters = no_parameters,
    .constants_size = sizeof(struct elasticity),
    .check = elasticity_check_alone,
    .prepare = elasticity_prepare_alone,
    .wave_speed = elasticity_wave_speed,
    .update_stress = update_stress,
    .strain_energy = elasticity_strain_energy,
    .strain_from_stress = elasticity_strain_from_stress,
};

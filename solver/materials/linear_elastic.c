/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/elasticity.h"

static const struct parameter no_parameters[] = {{.key = NULL}};

static size_t check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    elasticity_check(values, &issues);
    return issues.count;
}

static void prepare(const double *values, void *constants)
{
    struct elasticity *elasticity = constants;
    *elasticity = elasticity_read(values);
}

static double wave_speed(const void *constants)
{
    return elasticity_wave_speed(constants);
}

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

static void strain_energy(const void *constants, const struct material_batch *batch, real *energy)
{
    elasticity_strain_energy(constants, batch, energy);
}

static void strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                               double strain[SYM3_COMPONENTS])
{
    elasticity_strain_from_stress(constants, stress, strain);
}

const struct material linear_elastic = {
    .name = "linear_elastic",
    .reference = "Mast 2013, eq. 3.45 (with 2 G on the deviator)",
    .summary = "isotropic linear elasticity; at finite strain in Hencky strain",
    .parameters = no_parameters,
    .constants_size = sizeof(struct elasticity),
    .check = check,
    .prepare = prepare,
    .wave_speed = wave_speed,
    .update_stress = update_stress,
    .strain_energy = strain_energy,
    .strain_from_stress = strain_from_stress,
};

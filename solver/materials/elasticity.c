/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/elasticity.h"

struct elasticity elasticity_read(const double *values)
{
    struct elasticity elasticity = {.density = values[ELASTICITY_DENSITY]};
    double young = values[ELASTICITY_YOUNG_MODULUS];
    double poisson = values[ELASTICITY_POISSON_RATIO];
    if (isnan(young)) {
        elasticity.bulk = values[ELASTICITY_BULK_MODULUS];
        elasticity.shear = values[ELASTICITY_SHEAR_MODULUS];
    } else {
        elasticity.bulk = young / (3.0 * (1.0 - 2.0 * poisson));
        elasticity.shear = young / (2.0 * (1.0 + poisson));
    }
    return elasticity;
}

void elasticity_check(const double *values, struct material_issues *issues)
{
    bool bulk = !isnan(values[ELASTICITY_BULK_MODULUS]);
    bool shear = !isnan(values[ELASTICITY_SHEAR_MODULUS]);
    bool young = !isnan(values[ELASTICITY_YOUNG_MODULUS]);
    bool poisson = !isnan(values[ELASTICITY_POISSON_RATIO]);

    if (bulk && poisson && !shear && !young)
        material_issue_add(issues, "poisson_ratio", "contradiction",
                           "poisson_ratio goes with young_modulus; bulk_modulus goes with "
                           "shear_modulus");
    if (young && shear && !bulk && !poisson)
        material_issue_add(issues, "shear_modulus", "contradiction",
                           "shear_modulus goes with bulk_modulus; young_modulus goes with "
                           "poisson_ratio");
}

size_t elasticity_check_alone(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    elasticity_check(values, &issues);
    return issues.count;
}

void elasticity_prepare_alone(const double *values, void *constants)
{
    struct elasticity *elasticity = constants;
    *elasticity = elasticity_read(values);
}

double elasticity_wave_speed(const void *constants)
{
    const struct elasticity *elasticity = constants;
    return sqrt((elasticity->bulk + 4.0 / 3.0 * elasticity->shear) / elasticity->density);
}

void elasticity_strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                                   double strain[SYM3_COMPONENTS])
{
    const struct elasticity *elasticity = constants;
    double mean = (stress[0] + stress[1] + stress[2]) / 3.0;
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        double spherical = component < 3 ? mean : 0.0;
        strain[component] = (stress[component] - spherical) / (2.0 * elasticity->shear) +
                            spherical / (3.0 * elasticity->bulk);
    }
}

TALUS_INLINE void strain_energy_kernel(const struct elasticity *elasticity,
                                       const struct material_batch *batch, size_t components,
                                       real *energy)
{
    const struct stiffness stiffness = elasticity_stiffness(elasticity);
    const size_t count = slot_count(batch);
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        struct sym3 strain = components_load(batch->strain, slot, components);
        energy[slot] = (real)0.5 * sym3_dot(elasticity_stress(stiffness, strain), strain);
    }
}

void elasticity_strain_energy(const void *constants, const struct material_batch *batch,
                              real *energy)
{
    const struct elasticity *elasticity = constants;
    if (batch->component_count == 3)
        strain_energy_kernel(elasticity, batch, 3, energy);
    else if (batch->component_count == 4)
        strain_energy_kernel(elasticity, batch, 4, energy);
    else
        strain_energy_kernel(elasticity, batch, 6, energy);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Compressible neo-Hookean solid, volume and shape apart (Simo and Hughes 1998, sec. 9.2):
 *
 *   W = K/2 (ln J)^2 + G/2 (tr b' - 3),   b' = J^(-2/3) b      per initial volume
 *   tau = K ln J 1 + G dev b'
 *
 * In the Hencky strain e that a batch holds, ln J = tr e and b' = exp(2 dev e). With
 * E = (b' - 1)/2 the stress is K tr(e) 1 + 2 G dev E; at small strain E becomes dev e, and the
 * model linear_elastic. */
#include "materials/elasticity.h"

#include "math/log_strain.h"

static const struct parameter no_parameters[] = {{.key = NULL}};

/* E of slots begin ... begin + count - 1, and the traces of their strain. */
struct shape_change {
    MATERIAL_ALIGNED real volumetric[MATERIAL_CHUNK]; /* tr e */
    MATERIAL_ALIGNED real shape[SYM3_COMPONENTS][MATERIAL_CHUNK];
};

TALUS_INLINE void shape_changes(const struct material_batch *batch, size_t components, size_t begin,
                                size_t count, struct shape_change *change)
{
    real *shape[SYM3_COMPONENTS];
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        shape[component] = change->shape[component];
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        const struct sym3 strain = components_load(batch->strain, begin + index, components);
        change->volumetric[index] = sym3_trace(strain);
        components_store(shape, index, components, sym3_deviator(strain));
    }
    exp_strain_batch(count, components, shape, shape);
}

TALUS_INLINE void update_stress_kernel(const struct elasticity *elasticity,
                                       const struct material_batch *batch, size_t components)
{
    const struct stiffness stiffness = elasticity_stiffness(elasticity);
    const real bulk = stiffness.bulk * (real)(1.0 / 3.0);
    const size_t slots = slot_count(batch);
    struct shape_change change;
    real *shape[SYM3_COMPONENTS];
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        shape[component] = change.shape[component];
    for (size_t begin = 0; begin < slots; begin += MATERIAL_CHUNK) {
        const size_t count = chunk_count(slots, begin);
        shape_changes(batch, components, begin, count, &change);
#pragma omp simd
        for (size_t index = 0; index < count; index++) {
            const struct sym3 deviator = sym3_deviator(components_load(shape, index, components));
            components_store(batch->stress, begin + index, components,
                             sym3_add_diagonal(sym3_scale(stiffness.shear, deviator),
                                               bulk * change.volumetric[index]));
        }
    }
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct elasticity *elasticity = constants;
    MATERIAL_INSTANTIATE(update_stress_kernel, elasticity, batch);
    return false;
}

/* tr E is of second order in the strain: the sum of its terms would keep half of the digits. But
 * det b' = 1, or tr E (1 + tr E) = |E|^2 - 4 det E. */
TALUS_INLINE void strain_energy_kernel(const struct elasticity *elasticity,
                                       const struct material_batch *batch, size_t components,
                                       real *energy)
{
    const real half_bulk = (real)(0.5 * elasticity->bulk);
    const real shear = (real)elasticity->shear;
    const size_t slots = slot_count(batch);
    struct shape_change change;
    real *shape[SYM3_COMPONENTS];
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        shape[component] = change.shape[component];
    for (size_t begin = 0; begin < slots; begin += MATERIAL_CHUNK) {
        const size_t count = chunk_count(slots, begin);
        shape_changes(batch, components, begin, count, &change);
#pragma omp simd
        for (size_t index = 0; index < count; index++) {
            const struct sym3 e = components_load(shape, index, components);
            const real trace = (sym3_dot(e, e) - 4 * sym3_determinant(e)) / (1 + sym3_trace(e));
            const real volumetric = change.volumetric[index];
            energy[begin + index] = half_bulk * volumetric * volumetric + shear * trace;
        }
    }
}

static void strain_energy(const void *constants, const struct material_batch *batch, real *energy)
{
    const struct elasticity *elasticity = constants;
    if (batch->component_count == 3)
        strain_energy_kernel(elasticity, batch, 3, energy);
    else if (batch->component_count == 4)
        strain_energy_kernel(elasticity, batch, 4, energy);
    else
        strain_energy_kernel(elasticity, batch, 6, energy);
}

/* b' = s/G + (1 + y) 1 has the determinant 1: y of the largest root of
 * (1 + y)^3 - q (1 + y) + d = 1 with q = |s|^2/(2 G^2) and d = det s/G^3, by Newton's method, which
 * falls from a start above it. */
static double spherical_part(double q, double d)
{
    double y = 1.2 * sqrt(q);
    double last;
    do {
        const double x = 1.0 + y;
        last = y;
        y -= (y * (3.0 + y * (3.0 + y)) - q * x + d) / (3.0 * x * x - q);
    } while (y < last);
    return y;
}

static void strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                               double strain[SYM3_COMPONENTS])
{
    const struct elasticity *elasticity = constants;
    const double mean = (stress[0] + stress[1] + stress[2]) / 3.0;
    double s[SYM3_COMPONENTS]; /* over G */
    real shape[SYM3_COMPONENTS];
    real *components[SYM3_COMPONENTS];
    for (int component = 0; component < SYM3_COMPONENTS; component++) {
        s[component] = (stress[component] - (component < 3 ? mean : 0.0)) / elasticity->shear;
        components[component] = &shape[component];
    }
    const double square =
        s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
    const double determinant = s[0] * (s[1] * s[2] - s[4] * s[4]) -
                               s[3] * (s[3] * s[2] - s[4] * s[5]) +
                               s[5] * (s[3] * s[4] - s[1] * s[5]);
    const double y = spherical_part(0.5 * square, determinant);
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        shape[component] = (real)(0.5 * (s[component] + (component < 3 ? y : 0.0)));
    (void)log_strain_batch(1, SYM3_COMPONENTS, components, components); /* b' is definite */
    for (int component = 0; component < SYM3_COMPONENTS; component++)
        strain[component] =
            shape[component] + (component < 3 ? mean / (3.0 * elasticity->bulk) : 0);
}

const struct material neo_hookean = {
    .name = "neo_hookean",
    .reference = "Simo and Hughes 1998, sec. 9.2, with K/2 (ln J)^2 for the volume",
    .summary = "compressible neo-Hookean solid, for large elastic strains",
    .parameters = no_parameters,
    .constants_size = sizeof(struct elasticity),
    .check = elasticity_check_alone,
    .prepare = elasticity_prepare_alone,
    .wave_speed = elasticity_wave_speed,
    .update_stress = update_stress,
    .strain_energy = strain_energy,
    .strain_from_stress = strain_from_stress,
};

/* SPDX-License-Identifier: Apache-2.0 */
/* J2 plasticity with linear isotropic and kinematic hardening, by the closed-form radial return
 * (Mast 2013, eq. 3.69-3.83; a_iso grows by sqrt(2/3) dgam, as his 3.82 needs and 3.74 misprints):
 *
 *   eta = s - 2/3 H a_kin      F = |eta| - sqrt(2/3) (sigma_Y + k a_iso)
 *
 * At finite strain the back strain turns with the material, or a stressed body that spins would
 * harden; the source, which returns in principal space, leaves that open. */
#include "materials/elasticity.h"

struct j2 {
    struct elasticity elasticity;
    double yield_stress;        /* sigma_Y, uniaxial [Pa] */
    double isotropic_hardening; /* k [Pa] */
    double kinematic_hardening; /* H [Pa] */
};

enum value {
    VALUE_YIELD_STRESS = ELASTICITY_VALUE_COUNT,
    VALUE_ISOTROPIC_HARDENING,
    VALUE_KINEMATIC_HARDENING,
};

enum state {
    STATE_ISOTROPIC,
    STATE_BACK_STRAIN,
    STATE_COUNT = STATE_BACK_STRAIN + SYM3_COMPONENTS
};

static const char *const state_names[STATE_COUNT] = {
    "equivalent_plastic_strain",
    "back_strain_xx",
    "back_strain_yy",
    "back_strain_zz",
    "back_strain_xy",
    "back_strain_yz",
    "back_strain_xz",
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
    {.key = "isotropic_hardening",
     .symbol = "k",
     .unit = "Pa",
     .minimum = 0.0,
     .maximum = INFINITY,
     .default_value = 0.0,
     .meaning = "growth of the yield stress with uniaxial plastic strain"},
    {.key = "kinematic_hardening",
     .symbol = "H",
     .unit = "Pa",
     .minimum = 0.0,
     .maximum = INFINITY,
     .default_value = 0.0,
     .meaning = "growth of the back stress with uniaxial plastic strain"},
    {.key = NULL},
};

static size_t check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    elasticity_check(values, &issues);
    return issues.count;
}

static void prepare(const double *values, void *constants)
{
    struct j2 *j2 = constants;
    *j2 = (struct j2){
        .elasticity = elasticity_read(values),
        .yield_stress = values[VALUE_YIELD_STRESS],
        .isotropic_hardening = values[VALUE_ISOTROPIC_HARDENING],
        .kinematic_hardening = values[VALUE_KINEMATIC_HARDENING],
    };
}

static double wave_speed(const void *constants)
{
    const struct j2 *j2 = constants;
    return elasticity_wave_speed(&j2->elasticity);
}

/* The rotation of a step: Cayley transform of the spin, orthogonal for any step (Hughes and Winget
 * 1980). */
TALUS_INLINE struct mat3 spin_rotation(double xy, double yz, double xz)
{
    double scale = 1.0 / (1.0 + 0.25 * (xy * xy + yz * yz + xz * xz));
    struct mat3 spin = {{{0.0, xy, xz}, {-xy, 0.0, yz}, {-xz, -yz, 0.0}}};
    struct mat3 square = mat3_multiply(spin, spin);
    struct mat3 rotation;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            rotation.m[i][j] = (i == j ? 1.0 : 0.0) + scale * (spin.m[i][j] + 0.5 * square.m[i][j]);
    }
    return rotation;
}

TALUS_INLINE void turn_back_strain(const struct material_batch *batch, size_t components)
{
    double *const *back = batch->history + STATE_BACK_STRAIN;
    double time_step = batch->time_step;
#pragma omp simd
    for (size_t slot = 0; slot < batch->count; slot++) {
        double xy = time_step * batch->spin[0][slot];
        double yz = components > 4 ? time_step * batch->spin[1][slot] : 0.0;
        double xz = components > 4 ? time_step * batch->spin[2][slot] : 0.0;
        struct sym3 turned =
            sym3_push_forward(spin_rotation(xy, yz, xz), components_load(back, slot, components));
        components_store(back, slot, components, turned);
    }
}

/* 2/3 H back strain; `kinematic` is known to the compiler and spares the arrays where H is 0. */
TALUS_INLINE void radial_return(const struct j2 *constants, const struct material_batch *batch,
                                size_t components, bool kinematic)
{
    const struct j2 j2 = *constants;
    double *const *back = batch->history + STATE_BACK_STRAIN;
    double *isotropic = batch->history[STATE_ISOTROPIC];
    double root = sqrt(2.0 / 3.0);
    double shear = 2.0 * j2.elasticity.shear;
    double hardening = kinematic ? 2.0 / 3.0 * j2.kinematic_hardening : 0.0;
    double inverse = 1.0 / (shear + hardening + 2.0 / 3.0 * j2.isotropic_hardening);
#pragma omp simd
    for (size_t slot = 0; slot < batch->count; slot++) {
        struct sym3 strain = components_load(batch->strain, slot, components);
        struct sym3 relative = sym3_scale(shear, sym3_deviator(strain));
        struct sym3 back_strain = {0};
        if (kinematic) {
            back_strain = components_load(back, slot, components);
            relative = sym3_add_scaled(relative, -hardening, back_strain);
        }
        double norm = sym3_norm(relative);
        double strength = root * (j2.yield_stress + j2.isotropic_hardening * isotropic[slot]);
        double multiplier = maximum(norm - strength, 0.0) * inverse;
        double along = multiplier / (norm > 0.0 ? norm : 1.0);
        strain = sym3_add_scaled(strain, -along, relative);
        components_store(batch->strain, slot, components, strain);
        components_store(batch->stress, slot, components,
                         elasticity_stress(&j2.elasticity, strain));
        if (kinematic)
            components_store(back, slot, components, sym3_add_scaled(back_strain, along, relative));
        isotropic[slot] += root * multiplier;
        batch->plastic_strain[slot] = multiplier;
        /* what is not stored in the back strain (see strain_energy) is lost: |eta| dgam */
        batch->dissipation[slot] = (norm - (shear + hardening) * multiplier) * multiplier;
    }
}

TALUS_INLINE void update_stress_kernel(const struct j2 *j2, const struct material_batch *batch,
                                       size_t components)
{
    if (j2->kinematic_hardening == 0.0) {
        radial_return(j2, batch, components, false);
        return;
    }
    if (batch->spin[0] != NULL)
        turn_back_strain(batch, components);
    radial_return(j2, batch, components, true);
}

static void update_stress(const void *constants, const struct material_batch *batch)
{
    const struct j2 *j2 = constants;
    MATERIAL_INSTANTIATE(update_stress_kernel, j2, batch);
}

TALUS_INLINE void add_back_strain_energy(const struct j2 *j2, const struct material_batch *batch,
                                         size_t components, double *energy)
{
    double *const *back = batch->history + STATE_BACK_STRAIN;
    double factor = j2->kinematic_hardening / 3.0;
#pragma omp simd
    for (size_t slot = 0; slot < batch->count; slot++) {
        struct sym3 back_strain = components_load(back, slot, components);
        energy[slot] += factor * sym3_dot(back_strain, back_strain);
    }
}

/* Elastic energy and that of the back strain, H/3 |a_kin|^2, which a reversed load recovers. */
static void strain_energy(const void *constants, const struct material_batch *batch, double *energy)
{
    const struct j2 *j2 = constants;
    elasticity_strain_energy(&j2->elasticity, batch, energy);
    if (j2->kinematic_hardening == 0.0)
        return;
    if (batch->component_count == 3)
        add_back_strain_energy(j2, batch, 3, energy);
    else if (batch->component_count == 4)
        add_back_strain_energy(j2, batch, 4, energy);
    else
        add_back_strain_energy(j2, batch, 6, energy);
}

static void strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                               double strain[SYM3_COMPONENTS])
{
    const struct j2 *j2 = constants;
    elasticity_strain_from_stress(&j2->elasticity, stress, strain);
}

const struct material j2 = {
    .name = "j2",
    .reference = "Mast 2013, eq. 3.69-3.83",
    .summary = "von Mises plasticity with linear isotropic and kinematic hardening",
    .parameters = parameters,
    .needs_spin = true,
    .plastic = true,
    .state_count = STATE_COUNT,
    .state_names = state_names,
    .constants_size = sizeof(struct j2),
    .check = check,
    .prepare = prepare,
    .wave_speed = wave_speed,
    .update_stress = update_stress,
    .strain_energy = strain_energy,
    .strain_from_stress = strain_from_stress,
};

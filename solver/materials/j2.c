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

/* The back strain is zero before the first flow, which leaves its mark in the isotropic variable.
 */
TALUS_INLINE void turn_back_strain(const struct material_batch *batch, size_t components)
{
    real *const *back = batch->history + STATE_BACK_STRAIN;
    const real time_step = (real)batch->time_step;
    const size_t count = slot_count(batch);
    if (!number_bits(count, batch->history[STATE_ISOTROPIC]).nonzero)
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

struct j2_law { /* what the loops compute with */
    struct stiffness stiffness;
    real hardening;                /* 2/3 H */
    real initial_strength, growth; /* sqrt(2/3) sigma_Y and sqrt(2/3) k */
    real shear;                    /* 2 G + 2/3 H */
    real inverse;                  /* multiplier over what is beyond the surface [1/Pa] */
};

static struct j2_law j2_law_of(const struct j2 *j2)
{
    const double root = sqrt(2.0 / 3.0);
    const double hardening = 2.0 / 3.0 * j2->kinematic_hardening;
    const double shear = 2.0 * j2->elasticity.shear + hardening;
    return (struct j2_law){
        .stiffness = elasticity_stiffness(&j2->elasticity),
        .hardening = (real)hardening,
        .initial_strength = (real)(root * j2->yield_stress),
        .growth = (real)(root * j2->isotropic_hardening),
        .shear = (real)shear,
        .inverse = (real)(1.0 / (shear + 2.0 / 3.0 * j2->isotropic_hardening)),
    };
}

/* eta; `kinematic` is known to the compiler and spares the back strain where H is 0. */
TALUS_INLINE struct sym3 relative_stress(const struct j2_law *law, struct sym3 strain,
                                         struct sym3 back_strain, bool kinematic)
{
    struct sym3 stress = sym3_scale(law->stiffness.shear, sym3_deviator(strain));
    return kinematic ? sym3_add_scaled(stress, -law->hardening, back_strain) : stress;
}

TALUS_INLINE struct sym3 back_strain_load(const struct material_batch *batch, size_t slot,
                                          size_t components, bool kinematic)
{
    return kinematic ? components_load(batch->history + STATE_BACK_STRAIN, slot, components)
                     : (struct sym3){0};
}

/* Plastic strain, dissipation and isotropic variable out of along[] = |eta|, which becomes the
 * plastic strain over |eta|. */
static void flow(const struct j2_law *constants, const struct material_batch *batch, size_t begin,
                 size_t count, real *along)
{
    const struct j2_law law = *constants;
    const real root = (real)0.816496580927726; /* sqrt(2/3) */
    real *isotropic = batch->history[STATE_ISOTROPIC] + begin;
    real *plastic_strain = batch->plastic_strain + begin;
    real *dissipation = batch->dissipation + begin;
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real norm = along[index];
        real strength = law.initial_strength + law.growth * isotropic[index];
        real multiplier = maximum(norm - strength, 0) * law.inverse;
        along[index] = multiplier / (norm > 0 ? norm : 1);
        isotropic[index] += root * multiplier;
        plastic_strain[index] = multiplier;
        /* what is not stored in the back strain (see strain_energy) is lost: |eta| dgam */
        dissipation[index] = (norm - law.shear * multiplier) * multiplier;
    }
}

TALUS_INLINE void apply(const struct j2_law *constants, const struct material_batch *batch,
                        size_t components, bool kinematic, size_t begin, size_t count,
                        const real *along)
{
    const struct j2_law law = *constants;
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        size_t slot = begin + index;
        struct sym3 strain = components_load(batch->strain, slot, components);
        struct sym3 back_strain = back_strain_load(batch, slot, components, kinematic);
        struct sym3 relative = relative_stress(&law, strain, back_strain, kinematic);
        strain = sym3_add_scaled(strain, -along[index], relative);
        components_store(batch->strain, slot, components, strain);
        components_store(batch->stress, slot, components, elasticity_stress(law.stiffness, strain));
        if (kinematic)
            components_store(batch->history + STATE_BACK_STRAIN, slot, components,
                             sym3_add_scaled(back_strain, along[index], relative));
    }
}

TALUS_INLINE bool radial_return(const struct j2 *j2, const struct material_batch *batch,
                                size_t components, bool kinematic)
{
    const struct j2_law law = j2_law_of(j2);
    const size_t slots = slot_count(batch);
    MATERIAL_ALIGNED real along[MATERIAL_CHUNK];
    bool flowed = false;
    for (size_t begin = 0; begin < slots; begin += MATERIAL_CHUNK) {
        const size_t count = chunk_count(slots, begin);
#pragma omp simd
        for (size_t index = 0; index < count; index++) {
            size_t slot = begin + index;
            struct sym3 strain = components_load(batch->strain, slot, components);
            struct sym3 back_strain = back_strain_load(batch, slot, components, kinematic);
            along[index] = sym3_norm(relative_stress(&law, strain, back_strain, kinematic));
        }
        flow(&law, batch, begin, count, along);
        if (any_flowed(batch, begin, count)) {
            apply(&law, batch, components, kinematic, begin, count, along);
            flowed = true;
        } else {
            elasticity_apply(law.stiffness, batch, components, begin, count);
        }
    }
    return flowed;
}

TALUS_INLINE bool update_stress_kernel(const struct j2 *j2, const struct material_batch *batch,
                                       size_t components)
{
    if (j2->kinematic_hardening == 0.0)
        return radial_return(j2, batch, components, false);
    if (batch->spin[0] != NULL)
        turn_back_strain(batch, components);
    return radial_return(j2, batch, components, true);
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct j2 *j2 = constants;
    return MATERIAL_INSTANTIATE(update_stress_kernel, j2, batch);
}

TALUS_INLINE void add_back_strain_energy(const struct j2 *j2, const struct material_batch *batch,
                                         size_t components, real *energy)
{
    real *const *back = batch->history + STATE_BACK_STRAIN;
    const real factor = (real)(j2->kinematic_hardening / 3.0);
    const size_t count = slot_count(batch);
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        struct sym3 back_strain = components_load(back, slot, components);
        energy[slot] += factor * sym3_dot(back_strain, back_strain);
    }
}

/* Elastic energy and that of the back strain, H/3 |a_kin|^2, which a reversed load recovers. */
static void strain_energy(const void *constants, const struct material_batch *batch, real *energy)
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
    .dissipates = true,
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

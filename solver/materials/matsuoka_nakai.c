/* SPDX-License-Identifier: Apache-2.0 */
/* Matsuoka-Nakai yield (Mast 2013, sec. 3.7) with the potential of Drucker-Prager or its own. */
#include "materials/matsuoka_nakai_flow.h"

enum { VALUE_POTENTIAL = MOBILISED_VALUE_COUNT };

static const char *const potentials[] = {"drucker_prager", "matsuoka_nakai", NULL};
enum { POTENTIAL_DRUCKER_PRAGER, POTENTIAL_MATSUOKA_NAKAI };

struct matsuoka_nakai { /* the functions of mobilised.h take the first member */
    struct mobilised mobilised;
    bool own_potential;
};

static const struct parameter parameters[] = {
#include "materials/mobilised_parameters.def"
    {.key = "potential",
     .symbol = "",
     .unit = "1",
     .kind = PARAMETER_CHOICE,
     .minimum = 0.0,
     .maximum = 1.0,
     .default_value = 0.0,
     .choices = potentials,
     .meaning =
         "surface whose normal is the direction of plastic flow; matsuoka_nakai for dilation "
         "angles from 1 degree, drucker_prager below"},
    {.key = NULL},
};

static void surface_slopes(size_t count, const real *tangents, const struct invariants *invariants,
                           real *slopes)
{
    MATERIAL_ALIGNED real half[MATERIAL_CHUNK];
    MATERIAL_ALIGNED real size[MATERIAL_CHUNK];
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        struct matsuoka_nakai_root root = matsuoka_nakai_start(
            tangents[index], invariants->norm[index], invariants->determinant[index]);
        half[index] = root.half;
        size[index] = root.size;
    }
#pragma omp simd
    for (size_t index = 0; index < count; index++)
        slopes[index] =
            matsuoka_nakai_slope((struct matsuoka_nakai_root){half[index], size[index]});
}

static void prepare(const double *values, void *constants)
{
    struct matsuoka_nakai *model = constants;
    mobilised_prepare(values, &model->mobilised);
    model->own_potential = values[VALUE_POTENTIAL] == POTENTIAL_MATSUOKA_NAKAI;
}

TALUS_INLINE bool update_stress_kernel(const struct matsuoka_nakai *model,
                                       const struct material_batch *batch, size_t components)
{
    const struct mobilised *mobilised = &model->mobilised;
    if (model->own_potential)
        return mobilised_update(mobilised, batch, components, surface_slopes, INVARIANTS_OF_TURNING,
                                matsuoka_nakai_flow);
    return mobilised_update(mobilised, batch, components, surface_slopes, INVARIANTS_OF_DIRECTION,
                            NULL);
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct matsuoka_nakai *model = constants;
    return MATERIAL_INSTANTIATE(update_stress_kernel, model, batch);
}

const struct material matsuoka_nakai = {
    .name = "matsuoka_nakai",
    .reference = "Mast 2013, sec. 3.7 and eq. 3.112-3.120",
    .summary = "Matsuoka-Nakai yield with mobilised friction, Drucker-Prager flow or its own",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
    .state_count = MOBILISED_STATE_COUNT,
    .state_names = mobilised_state_names,
    .constants_size = sizeof(struct matsuoka_nakai),
    .check = mobilised_check,
    .prepare = prepare,
    .wave_speed = elasticity_wave_speed,
    .initialise = mobilised_initialise,
    .update_stress = update_stress,
    .strain_energy = elasticity_strain_energy,
    .strain_from_stress = elasticity_strain_from_stress,
    .initial_friction_angle_deg = mobilised_initial_friction_angle_deg,
};

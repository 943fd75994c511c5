/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/material_issue.h"
#include "materials/material_kernel.h"

struct newtonian_fluid {
    double density;   /* [kg/m^3] */
    double bulk;      /* K [Pa] */
    double viscosity; /* mu [Pa s] */
    double tension;   /* 1, or 0 where the fluid carries no tension */
};

enum value {
    VALUE_DENSITY = MATERIAL_VALUE_DENSITY,
    VALUE_BULK_MODULUS,
    VALUE_VISCOSITY,
    VALUE_NO_TENSION,
    VALUE_EQUATION_OF_STATE,
};

static const char *const equations_of_state[] = {"linear", NULL};
static const char *const reserved_equations_of_state[] = {"tait", NULL};
static const char *const reserved_keys[] = {"exponent", NULL};

static const struct parameter parameters[] = {
    {.key = "bulk_modulus",
     .symbol = "K",
     .unit = "Pa",
     .minimum = 0.0,
     .above_minimum = true,
     .maximum = INFINITY,
     .required = true,
     .default_value = NAN,
     .meaning = "pressure over volumetric strain"},
    {.key = "viscosity",
     .symbol = "mu",
     .unit = "Pa s",
     .minimum = 0.0,
     .maximum = INFINITY,
     .default_value = 0.0,
     .meaning = "dynamic viscosity; the viscous stress is 2 mu d"},
    {.key = "no_tension",
     .symbol = "",
     .unit = "1",
     .kind = PARAMETER_BOOLEAN,
     .minimum = 0.0,
     .maximum = 1.0,
     .default_value = 0.0,
     .meaning = "the fluid parts instead of carrying a negative pressure (splash)"},
    {.key = "equation_of_state",
     .symbol = "",
     .unit = "1",
     .kind = PARAMETER_CHOICE,
     .minimum = 0.0,
     .maximum = 0.0,
     .default_value = 0.0,
     .choices = equations_of_state,
     .reserved_choices = reserved_equations_of_state,
     .meaning = "how pressure follows from the volume: linear in ln J"},
    {.key = NULL},
};

static size_t check(const double *values, struct material_issue *issues, size_t capacity)
{
    (void)values;
    (void)issues;
    (void)capacity;
    return 0; /* each value stands alone */
}

static void prepare(const double *values, void *constants)
{
    struct newtonian_fluid *fluid = constants;
    *fluid = (struct newtonian_fluid){
        .density = values[VALUE_DENSITY],
        .bulk = values[VALUE_BULK_MODULUS],
        .viscosity = values[VALUE_VISCOSITY],
        .tension = values[VALUE_NO_TENSION] != 0.0 ? 0.0 : 1.0,
    };
}

static double wave_speed(const void *constants)
{
    const struct newtonian_fluid *fluid = constants;
    return sqrt(fluid->bulk / fluid->density);
}

static double viscosity(const void *constants)
{
    const struct newtonian_fluid *fluid = constants;
    return fluid->viscosity;
}

/* Volumetric strain that stores energy: an expanded fluid without tension stores none, but keeps
 * its strain, so that it carries load again only after it has closed. */
TALUS_INLINE real loaded_strain(real tension, real strain)
{
    return strain > 0 ? tension * strain : strain;
}

TALUS_INLINE void update_stress_kernel(const struct newtonian_fluid *fluid,
                                       const struct material_batch *batch, size_t components)
{
    const real bulk = (real)fluid->bulk;
    const real tension = (real)fluid->tension;
    const real viscosity = (real)(2.0 * fluid->viscosity);
    const real time_step = (real)batch->time_step;
    const size_t count = slot_count(batch);
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        struct sym3 rate = components_load_rate(batch, slot, components);
        /* tau = J sigma = K ln J 1 + J 2 mu d */
        real factor = viscosity * batch->volume_ratio[slot];
        real mean = bulk * loaded_strain(tension, batch->strain[0][slot]);
        components_store(batch->stress, slot, components,
                         sym3_add_diagonal(sym3_scale(factor, rate), mean));
        batch->dissipation[slot] = factor * sym3_dot(rate, rate) * time_step;
    }
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct newtonian_fluid *fluid = constants;
    MATERIAL_INSTANTIATE(update_stress_kernel, fluid, batch);
    return false;
}

static void strain_energy(const void *constants, const struct material_batch *batch, real *energy)
{
    const struct newtonian_fluid *fluid = constants;
    const real half_bulk = (real)(0.5 * fluid->bulk);
    const real tension = (real)fluid->tension;
    const size_t count = slot_count(batch);
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        real strain = loaded_strain(tension, batch->strain[0][slot]);
        energy[slot] = half_bulk * strain * strain;
    }
}

static void strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                               double strain[SYM3_COMPONENTS])
{
    const struct newtonian_fluid *fluid = constants;
    for (int component = 1; component < SYM3_COMPONENTS; component++)
        strain[component] = 0.0;
    strain[0] = (stress[0] + stress[1] + stress[2]) / (3.0 * fluid->bulk);
}

const struct material newtonian_fluid = {
    .name = "newtonian_fluid",
    .reference = "Mast 2013, sec. 6.1",
    .summary = "nearly incompressible fluid: pressure from the volume, 2 mu d from the rate",
    .parameters = parameters,
    .reserved_keys = reserved_keys,
    .own_elasticity = true,
    .volumetric = true,
    .needs_rate = true,
    .dissipates = true,
    .constants_size = sizeof(struct newtonian_fluid),
    .check = check,
    .prepare = prepare,
    .wave_speed = wave_speed,
    .viscosity = viscosity,
    .update_stress = update_stress,
    .strain_energy = strain_energy,
    .strain_from_stress = strain_from_stress,
};

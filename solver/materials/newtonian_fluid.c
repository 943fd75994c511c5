/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/material_issue.h"
#include "materials/material_kernel.h"
#include "math/elementary.h"

enum equation_of_state { STATE_LINEAR, STATE_TAIT };

static const double usual_exponent = 7.0; /* of water */

struct newtonian_fluid {
    double density;   /* [kg/m^3] */
    double bulk;      /* K [Pa] */
    double viscosity; /* mu [Pa s] */
    double tension;   /* 1, or 0 where the fluid carries no tension */
    enum equation_of_state equation_of_state;
    double exponent; /* gamma of Tait's equation */
};

enum value {
    VALUE_DENSITY = MATERIAL_VALUE_DENSITY,
    VALUE_BULK_MODULUS,
    VALUE_VISCOSITY,
    VALUE_NO_TENSION,
    VALUE_EQUATION_OF_STATE,
    VALUE_EXPONENT,
};

static const char *const equations_of_state[] = {"linear", "tait", NULL};

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
     .maximum = 1.0,
     .default_value = 0.0,
     .choices = equations_of_state,
     .meaning = "how pressure follows from the volume: J p = -K ln J, or Tait's "
                "p = K/gamma (J^-gamma - 1)"},
    {.key = "exponent",
     .symbol = "gamma",
     .unit = "1",
     .minimum = 1.0,
     .maximum = 100.0,
     .default_value = NAN,
     .meaning = "gamma of Tait's equation; 7, that of water, where absent"},
    {.key = NULL},
};

static size_t check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    if (values[VALUE_EQUATION_OF_STATE] == STATE_LINEAR && !isnan(values[VALUE_EXPONENT]))
        material_issue_add(&issues, "exponent", "contradiction",
                           "the linear equation of state has no exponent; it is Tait's");
    return issues.count;
}

static void prepare(const double *values, void *constants)
{
    struct newtonian_fluid *fluid = constants;
    *fluid = (struct newtonian_fluid){
        .density = values[VALUE_DENSITY],
        .bulk = values[VALUE_BULK_MODULUS],
        .viscosity = values[VALUE_VISCOSITY],
        .tension = values[VALUE_NO_TENSION] != 0.0 ? 0.0 : 1.0,
        .equation_of_state = (enum equation_of_state)values[VALUE_EQUATION_OF_STATE],
        .exponent = isnan(values[VALUE_EXPONENT]) ? usual_exponent : values[VALUE_EXPONENT],
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

/* What Tait's equation computes with. Per initial volume the pressure does the work
 *
 *   W = K/gamma (J^(1 - gamma)/(gamma - 1) + J - gamma/(gamma - 1)),   dW/dlnJ = -J p
 *
 * and gamma may be 1, where the first term becomes -ln J. */
struct tait {
    real stiffness; /* K / gamma [Pa] */
    real power;     /* 1 - gamma */
};

static struct tait tait_of(const struct newtonian_fluid *fluid)
{
    return (struct tait){(real)(fluid->bulk / fluid->exponent), (real)(1.0 - fluid->exponent)};
}

/* -J p of strain = ln J [Pa]. */
TALUS_INLINE real tait_stress(struct tait tait, real strain)
{
    return tait.stiffness * (elementary_expm1(strain) - elementary_expm1(tait.power * strain));
}

/* (exp(x) - 1 - x)/x^2, 1/2 at 0. */
TALUS_INLINE real exp_remainder(real x)
{
    const bool small = real_absolute(x) < (real)0.34;
    const real near = elementary_exp_remainder(small ? x : 0);
    const real y = small ? 1 : x;
    return small ? near : (elementary_expm1(y) - y) / (y * y);
}

/* W, in which the terms of first order have cancelled on paper. */
TALUS_INLINE real tait_energy(struct tait tait, real strain)
{
    return tait.stiffness * strain * strain *
           (exp_remainder(strain) - tait.power * exp_remainder(tait.power * strain));
}

/* Adds the viscous part to the mean stress in `mean`: tau = -J p 1 + J 2 mu d. */
TALUS_INLINE void store_stress(const struct newtonian_fluid *fluid,
                               const struct material_batch *batch, size_t components, size_t slot,
                               real mean)
{
    const real viscosity = (real)(2.0 * fluid->viscosity);
    const real time_step = (real)batch->time_step;
    struct sym3 rate = components_load_rate(batch, slot, components);
    real factor = viscosity * batch->volume_ratio[slot];
    components_store(batch->stress, slot, components,
                     sym3_add_diagonal(sym3_scale(factor, rate), mean));
    batch->dissipation[slot] = factor * sym3_dot(rate, rate) * time_step;
}

TALUS_INLINE void update_stress_kernel(const struct newtonian_fluid *constants,
                                       const struct material_batch *batch, size_t components)
{
    const struct newtonian_fluid fluid = *constants;
    const real bulk = (real)fluid.bulk;
    const real tension = (real)fluid.tension;
    const struct tait tait = tait_of(&fluid);
    const size_t count = slot_count(batch);
    if (fluid.equation_of_state == STATE_TAIT) {
#pragma omp simd
        for (size_t slot = 0; slot < count; slot++)
            store_stress(&fluid, batch, components, slot,
                         tait_stress(tait, loaded_strain(tension, batch->strain[0][slot])));
        return;
    }
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++)
        store_stress(&fluid, batch, components, slot,
                     bulk * loaded_strain(tension, batch->strain[0][slot]));
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
    const struct tait tait = tait_of(fluid);
    const size_t count = slot_count(batch);
    if (fluid->equation_of_state == STATE_TAIT) {
#pragma omp simd
        for (size_t slot = 0; slot < count; slot++)
            energy[slot] = tait_energy(tait, loaded_strain(tension, batch->strain[0][slot]));
        return;
    }
#pragma omp simd
    for (size_t slot = 0; slot < count; slot++) {
        real strain = loaded_strain(tension, batch->strain[0][slot]);
        energy[slot] = half_bulk * strain * strain;
    }
}

/* ln J of a stress by Tait's equation, by Newton's method: -J p rises with ln J throughout. */
static double tait_strain(const struct newtonian_fluid *fluid, double stress)
{
    enum { ITERATION_MAX = 100 };
    const double power = 1.0 - fluid->exponent;
    const double target = stress * fluid->exponent / fluid->bulk;
    double strain = stress / fluid->bulk;
    for (int iteration = 0; iteration < ITERATION_MAX; iteration++) {
        const double slope = exp(strain) - power * exp(power * strain);
        const double change = (expm1(strain) - expm1(power * strain) - target) / slope;
        strain -= change;
        if (fabs(change) <= 1e-16 * fabs(strain))
            break;
    }
    return strain;
}

static void strain_from_stress(const void *constants, const double stress[SYM3_COMPONENTS],
                               double strain[SYM3_COMPONENTS])
{
    const struct newtonian_fluid *fluid = constants;
    const double mean = (stress[0] + stress[1] + stress[2]) / 3.0;
    for (int component = 1; component < SYM3_COMPONENTS; component++)
        strain[component] = 0.0;
    strain[0] =
        fluid->equation_of_state == STATE_TAIT ? tait_strain(fluid, mean) : mean / fluid->bulk;
}

const struct material newtonian_fluid = {
    .name = "newtonian_fluid",
    .reference = "Mast 2013, sec. 6.1; Tait's equation: Monaghan 1994",
    .summary = "nearly incompressible fluid: pressure from the volume, 2 mu d from the rate",
    .parameters = parameters,
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

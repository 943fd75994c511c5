/* SPDX-License-Identifier: Apache-2.0 */
/* Mohr-Coulomb with a tension cut-off and strengths that fall from peak to residual with the
 * plastic shear strain. The strengths are those at the start of the step (semi-implicit), the
 * return to their surfaces is exact. The dilation angle stays what it is, but for a friction angle
 * that falls below it: then the flow is associated, because more dilation than friction would give
 * energy; and tension stays below the apex, c cot phi, as it falls. */
#include "materials/multi_surface.h"
#include "materials/softening.h"
#include "math/angle.h"
#include "math/elementary.h"

struct mohr_coulomb {
    struct elasticity elasticity;
    struct decay friction_deg;
    struct decay cohesion; /* [Pa] */
    struct softening softening;
    double dilation_deg;
    double tension; /* tensile strength [Pa], INFINITY: to the apex */
};
ELASTICITY_COMES_FIRST(struct mohr_coulomb);

enum value {
    VALUE_FRICTION_ANGLE = ELASTICITY_VALUE_COUNT,
    VALUE_DILATION_ANGLE,
    VALUE_COHESION,
    VALUE_TENSILE_STRENGTH,
    VALUE_RESIDUAL_FRICTION_ANGLE,
    VALUE_RESIDUAL_COHESION,
    VALUE_SOFTENING_RATE,
};

static const struct parameter parameters[] = {
    {.key = "friction_angle",
     .symbol = "phi",
     .unit = "deg",
     .minimum = 0.0,
     .maximum = 89.0,
     .required = true,
     .default_value = NAN,
     .meaning = "peak friction angle"},
    {.key = "dilation_angle",
     .symbol = "psi",
     .unit = "deg",
     .minimum = 0.0,
     .maximum = 89.0,
     .default_value = 0.0,
     .meaning = "dilation angle of the flow, at most the friction angle"},
    {.key = "cohesion",
     .symbol = "c",
     .unit = "Pa",
     .minimum = 0.0,
     .maximum = INFINITY,
     .default_value = 0.0,
     .meaning = "peak cohesion"},
    {.key = "tensile_strength",
     .symbol = "sigma_t",
     .unit = "Pa",
     .minimum = 0.0,
     .maximum = INFINITY,
     .default_value = NAN,
     .meaning = "largest principal tension; without it the apex, c cot phi"},
    {.key = "residual_friction_angle",
     .symbol = "phi_r",
     .unit = "deg",
     .minimum = 0.0,
     .maximum = 89.0,
     .default_value = NAN,
     .meaning = "friction angle after large plastic shear strain; goes with softening_rate"},
#include "materials/softening_parameters.def"
    {.key = NULL},
};

static size_t check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    const double friction = values[VALUE_FRICTION_ANGLE];
    const double cohesion = values[VALUE_COHESION];
    const double residual_friction = values[VALUE_RESIDUAL_FRICTION_ANGLE];
    const double residual_cohesion = values[VALUE_RESIDUAL_COHESION];
    elasticity_check(values, &issues);
    if (values[VALUE_DILATION_ANGLE] > friction)
        material_issue_add(&issues, "dilation_angle", "contradiction",
                           "dilation beyond the friction angle (%g) would make plastic flow a "
                           "source of energy",
                           friction);
    if (friction > 0.0 && values[VALUE_TENSILE_STRENGTH] * tan(angle_radians(friction)) > cohesion)
        material_issue_add(&issues, "tensile_strength", "contradiction",
                           "tension cannot pass the apex of the surface, c cot phi = %g Pa",
                           cohesion / tan(angle_radians(friction)));
    decay_check("residual_friction_angle", friction, residual_friction, &issues);
    decay_check("residual_cohesion", cohesion, residual_cohesion, &issues);
    softening_check(!isnan(residual_friction) || !isnan(residual_cohesion),
                    values[VALUE_SOFTENING_RATE], &issues);
    return issues.count;
}

static void prepare(const double *values, void *constants)
{
    struct mohr_coulomb *model = constants;
    const double tension = values[VALUE_TENSILE_STRENGTH];
    *model = (struct mohr_coulomb){
        .elasticity = elasticity_read(values),
        .friction_deg =
            decay_read(values[VALUE_FRICTION_ANGLE], values[VALUE_RESIDUAL_FRICTION_ANGLE]),
        .cohesion = decay_read(values[VALUE_COHESION], values[VALUE_RESIDUAL_COHESION]),
        .softening = softening_read(values[VALUE_SOFTENING_RATE]),
        .dilation_deg = values[VALUE_DILATION_ANGLE],
        .tension = isnan(tension) ? INFINITY : tension,
    };
}

/* sqrt((1 + sin)/(1 - sin)) of an angle given by its tangent. */
TALUS_INLINE real root_of_slope(real tangent)
{
    return real_sqrt(1 + tangent * tangent) + tangent;
}

struct surface { /* one slot's of struct surfaces */
    real slope, flow, strength, limit;
};

/* `share`: of the fall from peak to residual that is left. */
TALUS_INLINE struct surface surface_of(const struct mohr_coulomb *model, real root_of_flow,
                                       real share)
{
    const real degrees =
        (real)model->friction_deg.residual + (real)model->friction_deg.drop * share;
    const real cohesion = (real)model->cohesion.residual + (real)model->cohesion.drop * share;
    const real tangent = elementary_tangent_deg(degrees);
    const real root = root_of_slope(tangent);
    const real root_of_m = minimum(root, root_of_flow);
    const real apex = tangent > 0 ? cohesion / tangent : (real)INFINITY;
    return (struct surface){root * root, root_of_m * root_of_m, 2 * cohesion * root,
                            minimum((real)model->tension, apex)};
}

TALUS_INLINE void store_surface(struct surfaces *surfaces, size_t index, struct surface surface)
{
    surfaces->slope[index] = surface.slope;
    surfaces->flow[index] = surface.flow;
    surfaces->strength[index] = surface.strength;
    surfaces->limit[index] = surface.limit;
}

static void surfaces_of(const void *constants, const real *shear, size_t count,
                        struct surfaces *surfaces)
{
    const struct mohr_coulomb model = *(const struct mohr_coulomb *)constants;
    const real root_of_flow = root_of_slope(elementary_tangent_deg((real)model.dilation_deg));
    MATERIAL_ALIGNED real share[MATERIAL_CHUNK];
    count = whole_rows(count);
    if (!softening_shares(&model.softening, shear, count, share)) {
        const struct surface peak = surface_of(&model, root_of_flow, 1);
        for (size_t index = 0; index < count; index++)
            store_surface(surfaces, index, peak);
        return;
    }
#pragma omp simd
    for (size_t index = 0; index < count; index++)
        store_surface(surfaces, index, surface_of(&model, root_of_flow, share[index]));
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct mohr_coulomb *model = constants;
    return multi_surface_update(&model->elasticity, batch, surfaces_of, model, batch->history[0]);
}

static double initial_friction_angle_deg(const double *values)
{
    return values[VALUE_FRICTION_ANGLE];
}

const struct material mohr_coulomb = {
    .name = "mohr_coulomb",
    .reference = "Andersen and Andersen 2012, eq. 45-48; Clausen, Damkilde and Andersen 2006",
    .summary = "Mohr-Coulomb with tension cut-off, dilation, and peak to residual softening",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
    .state_count = 1,
    .state_names = softening_state_names,
    .constants_size = sizeof(struct mohr_coulomb),
    .check = check,
    .prepare = prepare,
    .wave_speed = elasticity_wave_speed,
    .update_stress = update_stress,
    .strain_energy = elasticity_strain_energy,
    .strain_from_stress = elasticity_strain_from_stress,
    .initial_friction_angle_deg = initial_friction_angle_deg,
};

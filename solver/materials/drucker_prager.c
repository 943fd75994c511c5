/* SPDX-License-Identifier: Apache-2.0 */
/* The traditional Drucker-Prager cone with linear hardening and a flat cut-off at its apex (Mast
 * 2013, sec. 3.6.1), eta = s - 2/3 H a_kin:
 *
 *   F1 = |eta| + rho_F I1 - mu - sqrt(2/3) k a_iso        flow |eta| + rho_G I1
 *   F2 = I1 - (mu + sqrt(2/3) k a_iso) / rho_F            flow I1
 *
 * (the sign of the apex in eq. 3.86 and 3.93 is wrong). Both surfaces are active where the return
 * to the cone alone would leave |eta| < 0, which is where the multiplier of F2 is positive. The
 * apex moves with a_iso: J21 of eq. 3.98 lacks 2 k / (3 rho_F), without which a cone that hardens
 * is not returned to its apex.
 *
 * Contraction (rho_G < 0) under tensile mean stress would make plastic work negative, which the
 * source leaves open: it ends at I1 = 0. The potential is |eta| beyond, and trials between the two
 * directions of flow return to I1 = 0. */
#include "materials/cone_parameters.h"
#include "materials/hardening.h"
#include "materials/invariants.h"

struct drucker_prager {
    struct hardening_solid solid;
    struct cone cone;
};

enum value {
    VALUE_ISOTROPIC_HARDENING = CONE_VALUE_COUNT, /* and the kinematic one */
};

static const struct parameter parameters[] = {
#define CONE_NEEDS_STRENGTH false
#include "materials/cone_parameters.def"
#include "materials/hardening_parameters.def"
    {.key = NULL},
};

static size_t check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    elasticity_check(values, &issues);
    if (issues.count == 0)
        cone_check(values, &issues);
    return issues.count;
}

static void prepare(const double *values, void *constants)
{
    struct drucker_prager *model = constants;
    *model = (struct drucker_prager){
        .solid = hardening_solid_read(values, VALUE_ISOTROPIC_HARDENING),
        .cone = cone_read(values),
    };
}

struct apex_cone_law { /* what the return computes with */
    struct cone_law cone;
    struct cone_law shearing; /* the same cone without dilation */
    real strength;            /* mu [Pa] */
    real growth, shear;       /* as in struct hardening_law */
    real shear_inverse;       /* 1/shear */
    real bulk_inverse;        /* 1/(9 K) */
    real slope_inverse;       /* 1/rho_F; 0 without friction, where there is no apex */
    bool contracts;           /* rho_G < 0 */
};

static struct apex_cone_law apex_cone_law_of(const struct drucker_prager *model,
                                             const struct hardening_law *hardening)
{
    const struct cone *cone = &model->cone;
    const struct cone shearing = {.slope = cone->slope, .strength = cone->strength};
    const double bulk = model->solid.elasticity.bulk;
    const double shear =
        2.0 * model->solid.elasticity.shear + 2.0 / 3.0 * model->solid.hardening.kinematic;
    const double isotropic = 2.0 / 3.0 * model->solid.hardening.isotropic;
    return (struct apex_cone_law){
        .cone = cone_law_of(cone, bulk, shear, isotropic),
        .shearing = cone_law_of(&shearing, bulk, shear, isotropic),
        .strength = (real)cone->strength,
        .growth = hardening->growth,
        .shear = hardening->shear,
        .shear_inverse = (real)(1.0 / shear),
        .bulk_inverse = (real)(1.0 / (9.0 * bulk)),
        .slope_inverse = cone->slope > 0.0 ? (real)(1.0 / cone->slope) : 0,
        .contracts = cone->flow_slope < 0.0,
    };
}

struct cone_point {  /* where a trial returns to */
    real multiplier; /* norm of the deviatoric plastic strain */
    real first;      /* I1 [Pa] */
};

/* The cone alone, along the flow of its potential. */
TALUS_INLINE struct cone_point return_to_cone(const struct apex_cone_law *law, bool contracts,
                                              real first, real norm, real strength)
{
    real multiplier = cone_multiplier(&law->cone, cone_excess(&law->cone, first, norm, strength));
    struct cone_point along = {multiplier, first - law->cone.flow_bulk * multiplier};
    if (!contracts)
        return along;
    real stop = maximum(first, 0);
    real shearing =
        cone_multiplier(&law->shearing, cone_excess(&law->shearing, stop, norm, strength));
    bool stops = along.first > stop;
    return (struct cone_point){stops ? shearing : multiplier, stops ? stop : along.first};
}

TALUS_INLINE void return_kernel(const struct apex_cone_law *constants,
                                const struct material_batch *batch, size_t begin, size_t count,
                                bool contracts, struct hardening_flow *flow)
{
    const struct apex_cone_law law = *constants;
    real *isotropic = batch->history[HARDENING_ISOTROPIC] + begin;
    real *plastic_strain = batch->plastic_strain + begin;
    real *dissipation = batch->dissipation + begin;
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real norm = flow->along[index];
        real first = flow->spherical[index];
        real strength = law.strength + law.growth * isotropic[index];
        struct cone_point end = return_to_cone(&law, contracts, first, norm, strength);
        real left = norm - law.shear * end.multiplier;
        bool to_apex = (left < 0) & (law.slope_inverse > 0);
        real multiplier = to_apex ? norm * law.shear_inverse : end.multiplier;
        real grown = strength + law.growth * HARDENING_ROOT * multiplier;
        real returned = to_apex ? grown * law.slope_inverse : end.first;
        left = maximum(norm - law.shear * multiplier, 0);
        real spherical = (first - returned) * law.bulk_inverse;
        flow->along[index] = multiplier / (norm > 0 ? norm : 1);
        flow->spherical[index] = spherical;
        isotropic[index] += HARDENING_ROOT * multiplier;
        plastic_strain[index] = flow_norm(multiplier, spherical);
        /* what is not stored in the back strain is lost */
        dissipation[index] = flow_dissipation(left, returned, multiplier, spherical);
    }
}

static void apex_cone_return(const void *constants, const struct material_batch *batch,
                             size_t begin, size_t count, struct hardening_flow *flow)
{
    const struct apex_cone_law *law = constants;
    if (law->contracts)
        return_kernel(law, batch, begin, count, true, flow);
    else
        return_kernel(law, batch, begin, count, false, flow);
}

TALUS_INLINE bool update_stress_kernel(const struct drucker_prager *model,
                                       const struct material_batch *batch, size_t components)
{
    const struct hardening_law hardening = hardening_law_of(&model->solid);
    const struct apex_cone_law law = apex_cone_law_of(model, &hardening);
    return hardening_update(&hardening, apex_cone_return, &law, batch, components, true);
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct drucker_prager *model = constants;
    return MATERIAL_INSTANTIATE(update_stress_kernel, model, batch);
}

const struct material drucker_prager = {
    .name = "drucker_prager",
    .reference = "Mast 2013, sec. 3.6.1 (eq. 3.74, 3.86, 3.93 and 3.98 corrected)",
    .summary = "Drucker-Prager cone with linear hardening and a tension cut-off at the apex",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
    .state_count = HARDENING_STATE_COUNT,
    .state_names = hardening_state_names,
    .constants_size = sizeof(struct drucker_prager),
    .check = check,
    .prepare = prepare,
    .wave_speed = elasticity_wave_speed,
    .needs_spin = hardening_needs_spin,
    .update_stress = update_stress,
    .strain_energy = hardening_strain_energy,
    .strain_from_stress = elasticity_strain_from_stress,
    .initial_friction_angle_deg = cone_friction_angle_deg,
};

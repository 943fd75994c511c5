/* SPDX-License-Identifier: Apache-2.0 */
/* Parameters of the capped cone; the return is in cap_return.h. */
#include "materials/cap_return.h"

static const struct parameter parameters[] = {
#define CONE_NEEDS_STRENGTH true
#include "materials/cone_parameters.def"
    {.key = NULL},
};

static size_t check(const double *values, struct material_issue *items, size_t capacity)
{
    struct material_issues issues = {.items = items, .capacity = capacity};
    elasticity_check(values, &issues);
    if (issues.count > 0)
        return issues.count;
    cone_check(values, &issues);
    struct cone cone = cone_read(values);
    if (issues.count == 0 && cone.slope * cone.flow_slope <= -1.0)
        material_issue_add(&issues, cone_flow_key(values), "limit",
                           "contraction is so strong that flow at the tip of the cone would be a "
                           "source of energy: rho_F rho_G must be above -1");
    return issues.count;
}

static void prepare(const double *values, void *constants)
{
    struct cap *cap = constants;
    struct cone cone = cone_read(values);
    double square = 1.0 + cone.slope * cone.slope;
    *cap = (struct cap){
        .elasticity = elasticity_read(values),
        .cone = cone,
        .radius = cone.strength / sqrt(square),
        .tangent_invariant = cone.slope * cone.strength / square,
        .tangent_norm = cone.strength / square,
    };
}

static bool update_stress(const void *constants, const struct material_batch *batch)
{
    const struct cap *cap = constants;
    return MATERIAL_INSTANTIATE(cap_update_stress, cap, batch);
}

const struct material drucker_prager_cap = {
    .name = "drucker_prager_cap",
    .reference = "Mast 2013, sec. 3.6.2, after Swan and Seo 1999 (eq. 3.101 corrected)",
    .summary = "Drucker-Prager cone, perfectly plastic, closed by a circular cap in tension",
    .parameters = parameters,
    .plastic = true,
    .dissipates = true,
    .constants_size = sizeof(struct cap),
    .check = check,
    .prepare = prepare,
    .wave_speed = elasticity_wave_speed,
    .update_stress = update_stress,
    .strain_energy = elasticity_strain_energy,
    .strain_from_stress = elasticity_strain_from_stress,
    .initial_friction_angle_deg = cone_friction_angle_deg,
};

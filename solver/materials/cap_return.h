/* SPDX-License-Identifier: Apache-2.0 */
/* Return to a Drucker-Prager cone closed by a circle about the origin of the (I1, |s|) plane (Mast
 * 2013, sec. 3.6.2, after Swan and Seo 1999):
 *
 *   F1 = |s| + rho_F I1 - mu      where I1 <= I_t    flow |s| + rho_G I1
 *   F2 = |s|^2 + I1^2 - R_t^2     beyond             associated flow
 *
 * The circle touches the cone at the tangent point (I_t, |s|_t) (eq. 3.101 lacks |s|^2). */
#ifndef TALUS_CAP_RETURN_H
#define TALUS_CAP_RETURN_H

#include "materials/invariants.h"

struct cap {
    struct elasticity elasticity;
    double slope, flow_slope; /* rho_F, rho_G [-] */
    double strength;          /* mu [Pa] */
    double radius;            /* R_t [Pa] */
    double tangent_invariant; /* I_t [Pa] */
    double tangent_norm;      /* |s|_t [Pa] */
};

struct cap_point {
    double first, norm; /* I1, |s| [Pa] */
};

/* Associated return to the circle: s = s_tr/(1 + 4 G x), I1 = I1_tr/(1 + 18 K x) with
 * n(x) = |(I1, |s|)| = R_t. 1/n - 1/R_t is concave and increasing, so that Newton's iteration from
 * any point below the root stays below it; it starts where the faster of the two decays alone would
 * end. The result is scaled onto the circle, which removes the last round-off. */
static inline struct cap_point cap_return_to_circle(const struct cap *cap, struct cap_point trial)
{
    enum { ITERATION_MAX = 60 };
    double shear = 4.0 * cap->elasticity.shear;
    double bulk = 18.0 * cap->elasticity.bulk;
    double excess = sqrt(trial.first * trial.first + trial.norm * trial.norm) / cap->radius;
    double multiplier = (excess - 1.0) / maximum(shear, bulk);
    struct cap_point point = trial;
    for (int iteration = 0; iteration < ITERATION_MAX; iteration++) {
        double shear_divisor = 1.0 + shear * multiplier;
        double bulk_divisor = 1.0 + bulk * multiplier;
        point.norm = trial.norm / shear_divisor;
        point.first = trial.first / bulk_divisor;
        double square = point.norm * point.norm + point.first * point.first;
        excess = sqrt(square) / cap->radius;
        if (excess <= 1.0 + 1e-14)
            break;
        double decay = shear * point.norm * point.norm / shear_divisor +
                       bulk * point.first * point.first / bulk_divisor;
        multiplier += (excess - 1.0) * square / decay;
    }
    point.norm /= excess;
    point.first /= excess;
    return point;
}

/* The cone where its return ends before the tangent point; all slots at once. Slots beyond it are
 * marked by a negative scale. */
TALUS_INLINE void cap_return_to_cone(const struct cap *cap, size_t count,
                                     struct invariants *invariants)
{
    const struct cap c = *cap;
    double shear = 2.0 * c.elasticity.shear;
    double bulk = 9.0 * c.elasticity.bulk * c.flow_slope;
    double inverse = 1.0 / (shear + bulk * c.slope);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        double first = invariants->trial[index];
        double norm = invariants->norm[index];
        double cone = norm + c.slope * first - c.strength;
        double circle = norm * norm + first * first - c.radius * c.radius;
        double multiplier = maximum(cone, 0.0) * inverse;
        double returned = first - bulk * multiplier;
        double scale = 1.0 - shear * multiplier / (norm > 0.0 ? norm : 1.0);
        bool beyond = returned > c.tangent_invariant; /* never with a negative |s| otherwise */
        bool inside = first > c.tangent_invariant && circle <= 0.0;
        double other = inside ? 1.0 : -1.0;
        invariants->first[index] = beyond ? first : returned;
        invariants->scale[index] = beyond ? other : scale;
    }
}

/* The slots that the cone's return left: circle, or the tangent point for trials between the flow
 * directions of the two surfaces. */
static inline void cap_return_beyond_cone(const struct cap *cap, size_t count,
                                          struct invariants *invariants)
{
    for (size_t index = 0; index < count; index++) {
        if (invariants->scale[index] >= 0.0)
            continue;
        struct cap_point trial = {invariants->trial[index], invariants->norm[index]};
        struct cap_point point = {cap->tangent_invariant, cap->tangent_norm};
        if (trial.first > cap->tangent_invariant) {
            struct cap_point on_circle = cap_return_to_circle(cap, trial);
            if (on_circle.first >= cap->tangent_invariant)
                point = on_circle;
        }
        invariants->first[index] = point.first;
        invariants->scale[index] = trial.norm > 0.0 ? point.norm / trial.norm : 1.0;
    }
}

TALUS_INLINE void cap_update_stress(const struct cap *cap, const struct material_batch *batch,
                                    size_t components)
{
    struct invariants invariants;
    for (size_t begin = 0; begin < batch->count; begin += MATERIAL_CHUNK) {
        size_t left = batch->count - begin;
        size_t count = left < MATERIAL_CHUNK ? left : MATERIAL_CHUNK;
        invariants_of_trial(&cap->elasticity, batch, components, begin, count, false, &invariants);
        cap_return_to_cone(cap, count, &invariants);
        cap_return_beyond_cone(cap, count, &invariants);
        invariants_apply(&cap->elasticity, batch, components, begin, count, &invariants);
    }
}

#endif

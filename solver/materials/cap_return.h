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

#include "materials/cone_parameters.h"
#include "materials/invariants.h"

struct cap {
    struct elasticity elasticity;
    struct cone cone;
    double radius;            /* R_t [Pa] */
    double tangent_invariant; /* I_t [Pa] */
    double tangent_norm;      /* |s|_t [Pa] */
};
ELASTICITY_COMES_FIRST(struct cap);

struct cap_law { /* what the loops compute with */
    struct stiffness stiffness;
    struct cone_law cone;
    real strength;
    real radius, radius_square, tangent_invariant, tangent_norm;
    real wedge_norm, wedge_first,
        wedge;                        /* positive between the flow directions of cone and circle */
    real shear_inverse, bulk_inverse; /* 1/(2 G) and 1/(9 K) */
};

static inline struct cap_law cap_law_of(const struct cap *cap)
{
    const double shear = 2.0 * cap->elasticity.shear;
    const double bulk = 9.0 * cap->elasticity.bulk;
    return (struct cap_law){
        .stiffness = elasticity_stiffness(&cap->elasticity),
        .cone = cone_law_of(&cap->cone, cap->elasticity.bulk, shear, 0.0),
        .strength = (real)cap->cone.strength,
        .radius = (real)cap->radius,
        .radius_square = (real)(cap->radius * cap->radius),
        .tangent_invariant = (real)cap->tangent_invariant,
        .tangent_norm = (real)cap->tangent_norm,
        .wedge_norm = (real)(bulk * cap->tangent_invariant),
        .wedge_first = (real)(shear * cap->tangent_norm),
        .wedge = (real)((bulk - shear) * cap->tangent_invariant * cap->tangent_norm),
        .shear_inverse = (real)(1.0 / shear),
        .bulk_inverse = (real)(1.0 / bulk),
    };
}

/* Marks the slots beyond the surface by a positive plastic strain; the others get what they
 * dissipate: nothing. */
static inline void cap_mark_yielding(const struct cap_law *constants,
                                     const struct material_batch *batch, size_t begin, size_t count,
                                     const struct invariants *invariants)
{
    const struct cap_law law = *constants;
    real *plastic_strain = batch->plastic_strain + begin;
    real *dissipation = batch->dissipation + begin;
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real first = invariants->first[index];
        real norm = invariants->norm[index];
        real cone = cone_excess(&law.cone, first, norm, law.strength);
        real circle = norm * norm + first * first - law.radius_square;
        plastic_strain[index] = maximum(first > law.tangent_invariant ? circle : cone, 0);
        dissipation[index] = 0;
    }
}

/* Cone and tangent point. The flow of the cone meets the tangent point or passes it; trials from
 * there to the flow direction of the circle at that point,
 *
 *   (I1 - I_t) / (|s| - |s|_t) = 9 K I_t / (2 G |s|_t),
 *
 * return to it. Slots that are left to the circle stay as they are and are marked by a negative
 * plastic strain. */
static inline void cap_return_to_cone(const struct cap_law *constants,
                                      const struct material_batch *batch, size_t begin,
                                      size_t count, struct invariants *invariants)
{
    const struct cap_law law = *constants;
    real *plastic_strain = batch->plastic_strain + begin;
    real *dissipation = batch->dissipation + begin;
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        real first = invariants->first[index];
        real norm = invariants->norm[index];
        real excess = cone_excess(&law.cone, first, norm, law.strength);
        real wedge = law.wedge_norm * norm - law.wedge_first * first - law.wedge;
        real multiplier = cone_multiplier(&law.cone, excess);
        bool beyond = first - law.cone.flow_bulk * multiplier > law.tangent_invariant;
        bool at_circle = (first > law.tangent_invariant) & (wedge < 0);
        bool yields = plastic_strain[index] > 0;
        bool to_circle = yields & beyond & at_circle;
        bool to_corner = yields & beyond & !at_circle;
        real along = beyond ? 0 : multiplier;
        real returned = to_corner ? law.tangent_invariant : first - law.cone.flow_bulk * along;
        real left = to_corner ? law.tangent_norm : norm - law.stiffness.shear * along;
        real deviatoric = (norm - left) * law.shear_inverse;
        real spherical = (first - returned) * law.bulk_inverse;
        real total = flow_norm(deviatoric, spherical);
        invariants->returned[index] = returned;
        invariants->scale[index] = left / (norm > 0 ? norm : 1);
        invariants->spherical[index] = spherical;
        plastic_strain[index] = to_circle ? -1 : total;
        dissipation[index] = flow_dissipation(left, returned, deviatoric, spherical);
    }
}

/* The slots that are left to the circle, side by side: full vectors however few and scattered they
 * are. Stresses in units of the radius, S = |s_tr| / R_t and T = I1_tr / R_t. */
struct cap_slots {
    size_t count;                 /* a multiple of MATERIAL_SLOT_MULTIPLE */
    size_t index[MATERIAL_CHUNK]; /* in the chunk; the last ones may be one and the same */
    MATERIAL_ALIGNED real norm[MATERIAL_CHUNK];       /* S */
    MATERIAL_ALIGNED real first[MATERIAL_CHUNK];      /* T */
    MATERIAL_ALIGNED real multiplier[MATERIAL_CHUNK]; /* x [1/Pa] */
    MATERIAL_ALIGNED real live[MATERIAL_CHUNK];       /* 1 where the iteration goes on, else 0 */
};

static inline void cap_slots_collect(const struct cap_law *law, const real *plastic_strain,
                                     size_t count, const struct invariants *invariants,
                                     struct cap_slots *slots)
{
    const real inverse = 1 / law->radius;
    size_t used = 0;
    for (size_t index = 0; index < count; index++) {
        slots->index[used] = index;
        used += plastic_strain[index] < 0;
    }
    for (; used % MATERIAL_SLOT_MULTIPLE != 0; used++)
        slots->index[used] = slots->index[used - 1];
    for (size_t place = 0; place < used; place++) {
        slots->norm[place] = invariants->norm[slots->index[place]] * inverse;
        slots->first[place] = invariants->first[slots->index[place]] * inverse;
    }
    slots->count = used;
}

/* Associated return to the circle: s = s_tr/(1 + a x), I1 = I1_tr/(1 + b x), a = 4 G, b = 18 K,
 * with n(x)^2 = S^2/(1 + a x)^2 + T^2/(1 + b x)^2 = 1. */
struct cap_step {
    real excess; /* n^2 - 1 */
    real change; /* of x */
};

/* One step of Halley's method for 1 - 1/n(x), with the root in n - 1 = sqrt(1 + y) - 1 replaced by
 * y (y + 4) / (4 (y + 2)), which keeps the order of convergence. */
TALUS_INLINE struct cap_step cap_halley(real shear, real bulk, real norm, real first, real x)
{
    real shear_divisor = 1 + shear * x;
    real bulk_divisor = 1 + bulk * x;
    real inverse = 1 / (shear_divisor * bulk_divisor);
    real shear_part = norm * bulk_divisor * inverse;
    real bulk_part = first * shear_divisor * inverse;
    shear_part *= shear_part;
    bulk_part *= bulk_part;
    shear *= bulk_divisor * inverse;
    bulk *= shear_divisor * inverse;
    /* n^2 and its derivatives over -2 and over 6 */
    real square = shear_part + bulk_part;
    real slope = shear * shear_part + bulk * bulk_part;
    real curvature = shear * shear * shear_part + bulk * bulk * bulk_part;
    real excess = square - 1;
    real top = excess * (excess + 4);
    real newton = (4 * excess + 8) * slope * slope;
    real halley = 2 * newton - 3 * top * (square * curvature - slope * slope);
    /* far off: at most twice Newton's step */
    return (struct cap_step){excess, 2 * top * square * slope / maximum(halley, newton)};
}

/* Where the iteration starts: the larger one of two estimates, Newton's step from x = 0 (a lower
 * bound) and the asymptote for trials far away. */
TALUS_INLINE real cap_start(real shear, real bulk, real norm, real first)
{
    real shear_part = norm * norm;
    real bulk_part = first * first;
    real square = shear_part + bulk_part;
    real near = (real_sqrt(square) - 1) * square / (shear * shear_part + bulk * bulk_part);
    shear = 1 / shear;
    bulk = 1 / bulk;
    shear_part *= shear * shear;
    bulk_part *= bulk * bulk;
    square = shear_part + bulk_part;
    real far = real_sqrt(square) - (shear * shear_part + bulk * bulk_part) / square;
    return maximum(near, far);
}

/* The slots iterate together, two or three steps for common stiffnesses; each stops where it would
 * stop alone: once the cube of its error, which the step leaves, is nothing. */
static inline void cap_slots_iterate(const struct cap_law *law, struct cap_slots *slots)
{
    enum { STEPS_MAX = 60 };
    const real tolerance = REAL_EPSILON / 64;
    const real shear = 2 * law->stiffness.shear;
    const real bulk = 6 * law->stiffness.bulk;
    const size_t count = whole_rows(slots->count);
#pragma omp simd
    for (size_t place = 0; place < count; place++) {
        slots->multiplier[place] = cap_start(shear, bulk, slots->norm[place], slots->first[place]);
        slots->live[place] = 1;
    }
    for (int iteration = 0; iteration < STEPS_MAX; iteration++) {
#pragma omp simd
        for (size_t place = 0; place < count; place++) {
            real x = slots->multiplier[place];
            real live = slots->live[place];
            struct cap_step step =
                cap_halley(shear, bulk, slots->norm[place], slots->first[place], x);
            real error = real_absolute(step.excess) * step.excess * step.excess;
            slots->multiplier[place] = live > 0 ? x + step.change : x;
            slots->live[place] = error > tolerance ? live : 0;
        }
        if (!number_bits(count, slots->live).nonzero)
            break;
    }
}

static inline void cap_slots_return(const struct cap_law *constants, struct cap_slots *slots,
                                    const struct material_batch *batch, size_t begin,
                                    struct invariants *invariants)
{
    const struct cap_law law = *constants;
    const real shear = 2 * law.stiffness.shear;
    const real bulk = 6 * law.stiffness.bulk;
    const size_t count = whole_rows(slots->count);
    MATERIAL_ALIGNED real plastic_strain[MATERIAL_CHUNK];
    MATERIAL_ALIGNED real dissipation[MATERIAL_CHUNK];
    MATERIAL_ALIGNED real scale[MATERIAL_CHUNK];
#pragma omp simd
    for (size_t place = 0; place < count; place++) {
        real shear_divisor = 1 + shear * slots->multiplier[place];
        real bulk_divisor = 1 + bulk * slots->multiplier[place];
        real norm = slots->norm[place] * bulk_divisor;
        real first = slots->first[place] * shear_divisor;
        /* scaled onto the circle, which removes the last round-off */
        real onto = law.radius / real_sqrt(norm * norm + first * first);
        real trial_norm = slots->norm[place] * law.radius;
        real left = norm * onto;
        real returned = first * onto;
        real deviatoric = (trial_norm - left) * law.shear_inverse;
        real spherical = (slots->first[place] * law.radius - returned) * law.bulk_inverse;
        scale[place] = bulk_divisor * onto / law.radius;
        slots->norm[place] = spherical;
        slots->first[place] = returned;
        plastic_strain[place] = flow_norm(deviatoric, spherical);
        dissipation[place] = flow_dissipation(left, returned, deviatoric, spherical);
    }
    for (size_t place = 0; place < count; place++) {
        const size_t index = slots->index[place];
        invariants->scale[index] = scale[place];
        invariants->spherical[index] = slots->norm[place];
        invariants->returned[index] = slots->first[place];
        batch->plastic_strain[begin + index] = plastic_strain[place];
        batch->dissipation[begin + index] = dissipation[place];
    }
}

static inline void cap_return_to_circle(const struct cap_law *law,
                                        const struct material_batch *batch, size_t begin,
                                        size_t count, struct invariants *invariants)
{
    struct cap_slots slots;
    cap_slots_collect(law, batch->plastic_strain + begin, count, invariants, &slots);
    cap_slots_iterate(law, &slots);
    cap_slots_return(law, &slots, batch, begin, invariants);
}

TALUS_INLINE bool cap_update_stress(const struct cap *cap, const struct material_batch *batch,
                                    size_t components)
{
    const struct cap_law law = cap_law_of(cap);
    const size_t slots = slot_count(batch);
    struct invariants invariants;
    bool flowed = false;
    for (size_t begin = 0; begin < slots; begin += MATERIAL_CHUNK) {
        const size_t count = chunk_count(slots, begin);
        invariants_of_trial(law.stiffness, batch, components, begin, count, INVARIANTS_OF_SCALING,
                            &invariants);
        cap_mark_yielding(&law, batch, begin, count, &invariants);
        if (!any_flowed(batch, begin, count)) {
            elasticity_apply(law.stiffness, batch, components, begin, count);
            continue;
        }
        flowed = true;
        cap_return_to_cone(&law, batch, begin, count, &invariants);
        if (number_bits(count, batch->plastic_strain + begin).negative)
            cap_return_to_circle(&law, batch, begin, count, &invariants);
        invariants_apply(law.stiffness, batch, components, begin, count, INVARIANTS_OF_SCALING,
                         &invariants);
    }
    return flowed;
}

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Which surfaces hold a trial. Shear first, without the limit:
 *
 *   I    the plane;  if its result violates s1 >= s2 >= s3, then
 *   II   the edge s1 = s2 (two planes), or  III  the edge s2 = s3.
 *
 * If that leaves s1 above the limit, tension takes part:
 *
 *   T    the tension plane, or two of them (s1 = s2), or all three (s1 = s2 = s3 = limit), if that
 *        leaves nothing beyond the shear planes; else
 *   S+T  shear and tension plane together: s1 = limit and s3 = corner, the stress at which the two
 *        meet, with s2 between them. Where the line ends, further planes hold: s2 = s1 or s2 = s3.
 *
 * Each subset of planes that misses others is followed by one with them; the matrix of what planes
 * do to each other has positive minors for m <= k and a positive stiffness, so that exactly one
 * subset holds (a linear complementarity problem), which the last one tried is. At the apex, where
 * limit and corner are one, S+T is the return to the apex. */
#include "materials/multi_surface.h"

#include <string.h>

struct stress { /* principal */
    real s1, s2, s3;
};

struct planes { /* one slot's surfaces and the stiffness between principal values */
    real k, m;
    real strength, limit;
    real along;  /* K + 4 G / 3 */
    real across; /* K - 2 G / 3 */
};

TALUS_INLINE struct stress choose(bool first, struct stress a, struct stress b)
{
    return (struct stress){first ? a.s1 : b.s1, first ? a.s2 : b.s2, first ? a.s3 : b.s3};
}

/* Stress of a unit of flow over the shear plane, times its normal: (k, 0, -1) C (m, 0, -1). */
TALUS_INLINE real plane_resistance(struct planes at)
{
    return at.k * at.m * at.along - (at.k + at.m) * at.across + at.along;
}

/* C (m, 0, -1) */
TALUS_INLINE struct stress plane_relief(struct planes at)
{
    return (struct stress){at.m * at.along - at.across, (at.m - 1) * at.across,
                           at.m * at.across - at.along};
}

/* Both planes of an edge resist a unit of flow over each by the same amount, so that half of the
 * sum of the excesses sets the sum of the flows, and the edge itself the rest. */
TALUS_INLINE struct stress to_edge_12(struct planes at, struct stress trial)
{
    const struct stress relief = plane_relief(at);
    const real other = at.k * relief.s2 - relief.s3;
    const real excess = at.k * (trial.s1 + trial.s2) - 2 * (trial.s3 + at.strength);
    const real s3 = trial.s3 - excess / (plane_resistance(at) + other) * relief.s3;
    const real s1 = (s3 + at.strength) / at.k;
    return (struct stress){s1, s1, s3};
}

TALUS_INLINE struct stress to_edge_23(struct planes at, struct stress trial)
{
    const struct stress relief = plane_relief(at);
    const real other = at.k * relief.s1 - relief.s2;
    const real excess = 2 * (at.k * trial.s1 - at.strength) - trial.s2 - trial.s3;
    const real s1 = trial.s1 - excess / (plane_resistance(at) + other) * relief.s1;
    const real s3 = at.k * s1 - at.strength;
    return (struct stress){s1, s3, s3};
}

TALUS_INLINE struct stress to_shear(struct planes at, struct stress trial, real excess)
{
    const struct stress relief = plane_relief(at);
    const real multiplier = maximum(excess, 0) / plane_resistance(at);
    const struct stress plane = {trial.s1 - multiplier * relief.s1,
                                 trial.s2 - multiplier * relief.s2,
                                 trial.s3 - multiplier * relief.s3};
    struct stress result = choose(plane.s2 > plane.s1, to_edge_12(at, trial), plane);
    return choose(plane.s3 > plane.s2, to_edge_23(at, trial), result);
}

TALUS_INLINE struct stress to_tension(struct planes at, struct stress trial)
{
    const real first = (trial.s1 - at.limit) / at.along;
    const real both = (trial.s1 + trial.s2 - 2 * at.limit) / (at.along + at.across);
    const struct stress one = {at.limit, trial.s2 - first * at.across,
                               trial.s3 - first * at.across};
    const struct stress two = {at.limit, at.limit, minimum(trial.s3 - both * at.across, at.limit)};
    return choose(one.s2 > at.limit, two, one);
}

/* `corner`: s3 where the shear plane meets the limit. */
TALUS_INLINE struct stress to_both(struct planes at, struct stress trial, real excess, real corner)
{
    const struct stress relief = plane_relief(at);
    const real beyond = trial.s1 - at.limit;
    const real inverse = 1 / (at.along * at.along - at.across * at.across);
    const real shear = inverse * (at.along * excess - (at.k * at.along - at.across) * beyond);
    const real tension = inverse * (plane_resistance(at) * beyond - relief.s1 * excess);
    const real s2 = trial.s2 - shear * relief.s2 - tension * at.across;
    return (struct stress){at.limit, minimum(maximum(s2, corner), at.limit), corner};
}

TALUS_INLINE struct stress to_surfaces(struct planes at, struct stress trial)
{
    const real excess = at.k * trial.s1 - trial.s3 - at.strength;
    const real corner = at.k * at.limit - at.strength;
    const struct stress sheared = to_shear(at, trial, excess);
    const struct stress torn = to_tension(at, trial);
    const struct stress tense = choose(torn.s3 >= corner, torn, to_both(at, trial, excess, corner));
    return choose(sheared.s1 > at.limit, tense, sheared);
}

static void return_stress(struct stiffness stiffness, const struct surfaces *surfaces,
                          struct principal *principal)
{
    const real across = (stiffness.bulk - stiffness.shear) * (real)(1.0 / 3.0);
    const real along = across + stiffness.shear;
    const size_t count = whole_rows(principal->count);
#pragma omp simd
    for (size_t place = 0; place < count; place++) {
        const struct planes at = {surfaces->slope[place],
                                  surfaces->flow[place],
                                  surfaces->strength[place],
                                  surfaces->limit[place],
                                  along,
                                  across};
        const struct stress trial = {principal->stress[0][place], principal->stress[1][place],
                                     principal->stress[2][place]};
        const struct stress result = to_surfaces(at, trial);
        principal->returned[0][place] = result.s1;
        principal->returned[1][place] = result.s2;
        principal->returned[2][place] = result.s3;
    }
}

/* Marks slots of a chunk that may be beyond a surface. */
static void mark(struct stiffness stiffness, const struct material_batch *batch, size_t begin,
                 size_t count, const struct surfaces *surfaces, real *marked)
{
    MATERIAL_ALIGNED real high[MATERIAL_CHUNK];
    MATERIAL_ALIGNED real low[MATERIAL_CHUNK];
    MATERIAL_ALIGNED real doubt[MATERIAL_CHUNK];
    count = whole_rows(count);
    principal_extremes(stiffness, batch, begin, count, high, low, doubt);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        const real k = surfaces->slope[index];
        const real shear = k * high[index] - low[index] - surfaces->strength[index];
        const real tension = high[index] - surfaces->limit[index];
        marked[index] = maximum(maximum(shear + (k + 1) * doubt[index], tension + doubt[index]), 0);
    }
}

/* Surfaces of the slots that were gathered, in place: a place is never behind its slot. Places
 * without a slot hold no stress and take any surfaces. */
static void gather_surfaces(const struct principal *principal, size_t begin,
                            struct surfaces *surfaces)
{
    for (size_t place = 0; place < principal->used; place++) {
        const size_t index = principal->slot[place] - begin;
        surfaces->slope[place] = surfaces->slope[index];
        surfaces->flow[place] = surfaces->flow[index];
        surfaces->strength[place] = surfaces->strength[index];
        surfaces->limit[place] = surfaces->limit[index];
    }
}

static void clear_flow(const struct material_batch *batch, size_t begin, size_t count)
{
    memset(batch->plastic_strain + begin, 0, count * sizeof(real));
    memset(batch->dissipation + begin, 0, count * sizeof(real));
}

static void apply_elastic(struct stiffness stiffness, const struct material_batch *batch,
                          size_t begin, size_t count)
{
    if (batch->component_count == 3)
        elasticity_apply(stiffness, batch, 3, begin, whole_rows(count));
    else if (batch->component_count == 4)
        elasticity_apply(stiffness, batch, 4, begin, whole_rows(count));
    else
        elasticity_apply(stiffness, batch, 6, begin, whole_rows(count));
}

bool multi_surface_update(const struct elasticity *elasticity, const struct material_batch *batch,
                          surfaces_at_start *surfaces_of, const void *model, real *shear)
{
    const struct stiffness stiffness = elasticity_stiffness(elasticity);
    const size_t slots = slot_count(batch);
    struct surfaces surfaces;
    struct principal principal;
    struct principal_flow flow;
    MATERIAL_ALIGNED real marked[MATERIAL_CHUNK];
    bool flowed = false;
    for (size_t begin = 0; begin < slots; begin += MATERIAL_CHUNK) {
        const size_t count = chunk_count(slots, begin);
        surfaces_of(model, shear + begin, count, &surfaces);
        mark(stiffness, batch, begin, count, &surfaces, marked);
        apply_elastic(stiffness, batch, begin, count);
        clear_flow(batch, begin, count);
        if (!number_bits(count, marked).nonzero)
            continue;
        principal_gather(stiffness, batch, begin, count, marked, &principal);
        gather_surfaces(&principal, begin, &surfaces);
        return_stress(stiffness, &surfaces, &principal);
        principal_scatter(stiffness, &principal, batch, &flow);
        for (size_t place = 0; place < principal.used; place++)
            shear[principal.slot[place]] += flow.shear[place];
        flowed = flowed || any_flowed(batch, begin, count);
    }
    return flowed;
}

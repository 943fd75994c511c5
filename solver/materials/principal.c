/* SPDX-License-Identifier: Apache-2.0 */
#include "materials/principal.h"

#include "math/principal_axes.h"

#include <string.h>

/* Error of principal values out of invariants, over the norm: the root of the rounding, where two
 * of them meet. */
#ifdef TALUS_SINGLE
#define VALUE_DOUBT 2e-3f
#else
#define VALUE_DOUBT 1e-7
#endif
struct extremes {
    real high, low;
};

/* Of a tensor without trace. */
TALUS_INLINE struct extremes deviator_extremes(struct sym3 d, size_t components)
{
    if (components == 6) {
        const real J2 = (real)0.5 * sym3_dot(d, d);
        const struct eigenvalues at =
            traceless_eigenvalues((struct invariants){J2, sym3_determinant(d)});
        return (struct extremes){maximum(at.far, at.last), minimum(at.far, at.last)};
    }
    real high = d.xx;
    real low = d.yy;
    if (components == 4) {
        const real mean = (real)0.5 * (d.xx + d.yy);
        const real half = (real)0.5 * (d.xx - d.yy);
        const real radius = real_sqrt(half * half + d.xy * d.xy);
        high = mean + radius;
        low = mean - radius;
    }
    return (struct extremes){maximum(maximum(high, low), d.zz), minimum(minimum(high, low), d.zz)};
}

TALUS_INLINE void extremes_kernel(struct stiffness stiffness, const struct material_batch *batch,
                                  size_t components, size_t begin, size_t count, real *high,
                                  real *low, real *doubt)
{
    count = whole_rows(count);
#pragma omp simd
    for (size_t index = 0; index < count; index++) {
        struct sym3 strain = components_load(batch->strain, begin + index, components);
        struct sym3 deviator = sym3_scale(stiffness.shear, sym3_deviator(strain));
        const real mean = stiffness.bulk * (real)(1.0 / 3.0) * sym3_trace(strain);
        const struct extremes of = deviator_extremes(deviator, components);
        high[index] = mean + of.high;
        low[index] = mean + of.low;
        doubt[index] = VALUE_DOUBT * (sym3_norm(deviator) + real_absolute(mean));
    }
}

void principal_extremes(struct stiffness stiffness, const struct material_batch *batch,
                        size_t begin, size_t count, real *high, real *low, real *doubt)
{
    if (batch->component_count == 3)
        extremes_kernel(stiffness, batch, 3, begin, count, high, low, doubt);
    else if (batch->component_count == 4)
        extremes_kernel(stiffness, batch, 4, begin, count, high, low, doubt);
    else
        extremes_kernel(stiffness, batch, 6, begin, count, high, low, doubt);
}

TALUS_INLINE void store_axis(struct principal *principal, size_t place, int index, real mean,
                             real scale, struct principal_axis axis)
{
    principal->stress[index][place] = mean + scale * axis.value;
    principal->axis[index][0][place] = axis.along.x;
    principal->axis[index][1][place] = axis.along.y;
    principal->axis[index][2][place] = axis.along.z;
}

TALUS_INLINE void find_axes(struct stiffness stiffness, size_t components,
                            struct principal *principal)
{
    real *strains[SYM3_COMPONENTS];
    const size_t count = whole_rows(principal->count);
    for (size_t component = 0; component < SYM3_COMPONENTS; component++)
        strains[component] = principal->strain[component];
#pragma omp simd
    for (size_t place = 0; place < count; place++) {
        const struct sym3 strain = components_load(strains, place, components);
        const struct sym3 deviator = sym3_deviator(strain);
        const real size = maximum(sym3_norm(deviator), PRINCIPAL_AXES_LEAST);
        const struct sym3 d = sym3_scale(1 / size, deviator);
        const real mean = stiffness.bulk * (real)(1.0 / 3.0) * sym3_trace(strain);
        const struct vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
        const struct principal_axis first =
            components == 6 ? principal_apart(d) : (struct principal_axis){d.zz, z};
        const struct principal_plane plane =
            components == 6 ? principal_across(d, first.along) : principal_plane_of(d, x, y);
        const real scale = stiffness.shear * size;
        store_axis(principal, place, 0, mean, scale, first);
        store_axis(principal, place, 1, mean, scale, principal_plane_first(plane));
        store_axis(principal, place, 2, mean, scale, principal_plane_second(plane));
    }
}

/* Exchanges two values, and their axes, where the first is the smaller one. */
static void order_pair(struct principal *principal, int first, int second)
{
    const size_t count = whole_rows(principal->count);
    MATERIAL_ALIGNED real rise[MATERIAL_CHUNK];
    real *pairs[4][2] = {{principal->stress[first], principal->stress[second]}};
    for (int component = 0; component < 3; component++) {
        pairs[1 + component][0] = principal->axis[first][component];
        pairs[1 + component][1] = principal->axis[second][component];
    }
#pragma omp simd
    for (size_t place = 0; place < count; place++)
        rise[place] = pairs[0][1][place] - pairs[0][0][place];
    for (int pair = 0; pair < 4; pair++) {
        real *a = pairs[pair][0];
        real *b = pairs[pair][1];
#pragma omp simd
        for (size_t place = 0; place < count; place++) {
            const real low = rise[place] > 0 ? a[place] : b[place];
            a[place] = rise[place] > 0 ? b[place] : a[place];
            b[place] = low;
        }
    }
}

TALUS_INLINE void decompose(struct stiffness stiffness, size_t components,
                            struct principal *principal)
{
    find_axes(stiffness, components, principal);
    order_pair(principal, 0, 1);
    order_pair(principal, 1, 2);
    order_pair(principal, 0, 1);
}

void principal_gather(struct stiffness stiffness, const struct material_batch *batch, size_t begin,
                      size_t count, const real *chosen, struct principal *principal)
{
    size_t used = 0;
    for (size_t index = 0; index < count; index++) {
        if (chosen[index] > 0)
            principal->slot[used++] = begin + index;
    }
    principal->used = used;
    principal->count = whole_rows(used + MATERIAL_SLOT_MULTIPLE - 1);
    for (size_t component = 0; component < batch->component_count; component++) {
        real *strain = principal->strain[component];
        for (size_t place = 0; place < used; place++)
            strain[place] = batch->strain[component][principal->slot[place]];
        for (size_t place = used; place < principal->count; place++)
            strain[place] = 0;
    }
    if (batch->component_count == 3)
        decompose(stiffness, 3, principal);
    else if (batch->component_count == 4)
        decompose(stiffness, 4, principal);
    else
        decompose(stiffness, 6, principal);
}

/* The plastic strain increments between trial and returned stress. */
TALUS_INLINE void find_flow(struct stiffness stiffness, const struct principal *principal,
                            struct principal_flow *flow)
{
    const real shear = 1 / stiffness.shear;
    const real bulk = 1 / stiffness.bulk;
    const size_t count = whole_rows(principal->count);
#pragma omp simd
    for (size_t place = 0; place < count; place++) {
        real lost[3], increment[3]; /* stress, strain */
        for (int index = 0; index < 3; index++)
            lost[index] = principal->stress[index][place] - principal->returned[index][place];
        const real mean = (real)(1.0 / 3.0) * (lost[0] + lost[1] + lost[2]);
        real square = 0, work = 0;
        for (int index = 0; index < 3; index++) {
            increment[index] = shear * (lost[index] - mean) + bulk * mean;
            square += increment[index] * increment[index];
            work += increment[index] * principal->returned[index][place];
        }
        const real high = maximum(maximum(increment[0], increment[1]), increment[2]);
        const real low = minimum(minimum(increment[0], increment[1]), increment[2]);
        flow->norm[place] = real_sqrt(square);
        flow->shear[place] = high - low;
        flow->dissipation[place] = maximum(work, 0); /* below by round-off only */
    }
}

/* Elastic strain of the returned stress, in place of that of the trial. */
TALUS_INLINE void find_strain(struct stiffness stiffness, size_t components,
                              struct principal *principal)
{
    const real shear = 1 / stiffness.shear;
    const real bulk = 1 / stiffness.bulk;
    const size_t count = whole_rows(principal->count);
    real *strains[SYM3_COMPONENTS];
    for (size_t component = 0; component < SYM3_COMPONENTS; component++)
        strains[component] = principal->strain[component];
#pragma omp simd
    for (size_t place = 0; place < count; place++) {
        const real mean =
            (real)(1.0 / 3.0) * (principal->returned[0][place] + principal->returned[1][place] +
                                 principal->returned[2][place]);
        struct sym3 strain = {bulk * mean, bulk * mean, bulk * mean, 0, 0, 0};
        for (int index = 0; index < 3; index++) {
            const real x = principal->axis[index][0][place];
            const real y = principal->axis[index][1][place];
            const real z = principal->axis[index][2][place];
            const struct sym3 dyad = {x * x, y * y, z * z, x * y, y * z, x * z};
            const real deviator = shear * (principal->returned[index][place] - mean);
            strain = sym3_add_scaled(strain, deviator, dyad);
        }
        components_store(strains, place, components, strain);
    }
}

TALUS_INLINE void scatter(struct stiffness stiffness, size_t components,
                          struct principal *principal, const struct material_batch *batch,
                          const struct principal_flow *flow)
{
    real *strains[SYM3_COMPONENTS];
    for (size_t component = 0; component < SYM3_COMPONENTS; component++)
        strains[component] = principal->strain[component];
    find_strain(stiffness, components, principal);
    for (size_t place = 0; place < principal->used; place++) {
        if (!(flow->norm[place] > 0))
            continue;
        const size_t slot = principal->slot[place];
        const struct sym3 strain = components_load(strains, place, components);
        components_store(batch->strain, slot, components, strain);
        components_store(batch->stress, slot, components, elasticity_stress(stiffness, strain));
        batch->plastic_strain[slot] = flow->norm[place];
        batch->dissipation[slot] = flow->dissipation[place];
    }
}

void principal_scatter(struct stiffness stiffness, struct principal *principal,
                       const struct material_batch *batch, struct principal_flow *flow)
{
    find_flow(stiffness, principal, flow);
    if (batch->component_count == 3)
        scatter(stiffness, 3, principal, batch, flow);
    else if (batch->component_count == 4)
        scatter(stiffness, 4, principal, batch, flow);
    else
        scatter(stiffness, 6, principal, batch, flow);
}

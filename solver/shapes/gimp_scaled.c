/* SPDX-License-Identifier: Apache-2.0 */
/* Generalised interpolation with boxes that follow the deformation: by volume,
 * l = l0 J^(1/axes) with J of the axes of the scene (Andersen and Andersen 2012, eq. 28), or along
 * every axis, l_a = l0_a U_aa with U = sqrt(F^T F) (Charlton, Coombs and Augarde 2017). Either
 * keeps the boxes aligned with the grid: they do not tile a body that is sheared or turned.
 * PARTICLE_DOMAIN holds l, then l0. */
#include "base/inline.h"
#include "math/elementary.h"
#include "math/log_strain.h"
#include "math/tensor.h"
#include "shapes/gimp.h"

#include <assert.h>
#include <string.h>

/* Principal stretches for which eq. 28 is good enough: beyond, boxes leave gaps along the stretch
 * and overlap across it. */
#define STRETCH_MIN 0.7
#define STRETCH_MAX 1.4

enum { BATCH = 64 }; /* slots at a time, whole rows */

static uint32_t component_count(size_t axis_count)
{
    return 2 * (uint32_t)axis_count;
}

static void initialise(size_t axis_count, const double size[3], real *domain)
{
    for (size_t axis = 0; axis < axis_count; axis++)
        domain[axis] = domain[axis_count + axis] = (real)(0.5 * size[axis]);
}

/* H = F - I of some slots; 0 beyond the axes. */
static void load_gradient(const struct shape_context *context, const struct particle_block *block,
                          size_t begin, size_t count, size_t axes, real h[9][BATCH])
{
    memset(h, 0, 9 * sizeof h[0]);
    for (uint32_t row = 0; row < axes; row++) {
        for (uint32_t column = 0; column < axes; column++) {
            const uint32_t component = (uint32_t)axes * row + column;
            memcpy(h[3 * row + column],
                   particle_values(context->particles, block, PARTICLE_GRADIENT, component) + begin,
                   count * sizeof(real));
        }
    }
}

/* (F^T F - I)/2. */
static void green_strain(size_t count, real h[9][BATCH], real e[6][BATCH])
{
    for (size_t row = 0; row < 3; row++) {
        for (size_t column = row; column < 3; column++) {
            real *sum = e[sym3_component[row][column]];
            for (size_t slot = 0; slot < count; slot++)
                sum[slot] = (real)0.5 * (h[3 * row + column][slot] + h[3 * column + row][slot] +
                                         h[row][slot] * h[column][slot] +
                                         h[3 + row][slot] * h[3 + column][slot] +
                                         h[6 + row][slot] * h[6 + column][slot]);
        }
    }
}

/* True if a 3 x 3 tensor is positive definite. */
TALUS_INLINE bool is_positive(real xx, real yy, real zz, real xy, real yz, real xz)
{
    const real minor = xx * yy - xy * xy;
    const real det = zz * minor - yz * (xx * yz - xy * xz) + xz * (xy * yz - yy * xz);
    return (xx > 0) & (minor > 0) & (det > 0);
}

/* Counts the particles whose principal stretches are outside of the limits: where C - min^2 I or
 * max^2 I - C is not positive definite. */
static void find_stretched(const struct particle_block *block, size_t begin, size_t count,
                           real e[6][BATCH], struct domain_findings *findings)
{
    const real low = (real)(0.5 * (STRETCH_MIN * STRETCH_MIN - 1));
    const real high = (real)(0.5 * (STRETCH_MAX * STRETCH_MAX - 1));
    for (size_t slot = 0; slot < count; slot++) {
        const real xy = e[3][slot], yz = e[4][slot], xz = e[5][slot];
        const bool above =
            is_positive(e[0][slot] - low, e[1][slot] - low, e[2][slot] - low, xy, yz, xz);
        const bool below =
            is_positive(high - e[0][slot], high - e[1][slot], high - e[2][slot], -xy, -yz, -xz);
        if (above && below)
            continue;
        if (block->id[begin + slot] != PARTICLE_NONE && findings->stretched++ == 0)
            findings->stretched_particle = block->id[begin + slot];
    }
}

/* l = l0 ratio, cut at the longest that the shape can be. */
static void set_lengths(const struct shape_context *context, const struct particle_block *block,
                        size_t begin, size_t count, size_t axes, real ratio[3][BATCH],
                        struct domain_findings *findings)
{
    bool longer[BATCH] = {false};
    for (uint32_t axis = 0; axis < axes; axis++) {
        real *half = particle_values(context->particles, block, PARTICLE_DOMAIN, axis) + begin;
        const real *start =
            particle_values(context->particles, block, PARTICLE_DOMAIN, (uint32_t)axes + axis) +
            begin;
        for (size_t slot = 0; slot < count; slot++) {
            const real length = start[slot] * ratio[axis][slot];
            longer[slot] |= length > (real)GIMP_HALF_MAX;
            half[slot] = length > (real)GIMP_HALF_MAX ? (real)GIMP_HALF_MAX : length;
        }
    }
    for (size_t slot = 0; slot < count; slot++) {
        if (longer[slot] && findings->capped++ == 0)
            findings->capped_particle = block->id[begin + slot];
    }
}

/* J^(1/axes) on all axes. */
static void volume_ratios(size_t count, size_t axes, real h[9][BATCH], real ratio[3][BATCH])
{
    const real power = (real)1.0 / (real)axes;
    for (size_t slot = 0; slot < count; slot++) {
        /* det(I + H) - 1 */
        const real trace = h[0][slot] + h[4][slot] + h[8][slot];
        const real xy = h[0][slot] * h[4][slot] - h[1][slot] * h[3][slot];
        const real yz = h[4][slot] * h[8][slot] - h[5][slot] * h[7][slot];
        const real xz = h[0][slot] * h[8][slot] - h[2][slot] * h[6][slot];
        const real det = h[0][slot] * yz -
                         h[1][slot] * (h[3][slot] * h[8][slot] - h[5][slot] * h[6][slot]) +
                         h[2][slot] * (h[3][slot] * h[7][slot] - h[4][slot] * h[6][slot]);
        const real change = trace + xy + yz + xz + det;
        const real root = elementary_exp(power * elementary_log1p(change));
        ratio[0][slot] = ratio[1][slot] = ratio[2][slot] = root;
    }
}

/* The diagonal of U = exp(ln(C)/2): e of C gives ln(C)/2, and half of that U as (U - I)/2. */
static void stretch_ratios(size_t count, size_t axes, real e[6][BATCH], real ratio[3][BATCH])
{
    real *const arrays[6] = {e[0], e[1], e[2], e[3], e[4], e[5]};
    const size_t components = axes == 1 ? 3 : axes == 2 ? 4 : 6;
    (void)log_strain_batch(count, components, arrays, arrays);
    for (size_t component = 0; component < components; component++) {
        for (size_t slot = 0; slot < count; slot++)
            e[component][slot] *= (real)0.5;
    }
    exp_strain_batch(count, components, arrays, arrays);
    for (size_t axis = 0; axis < 3; axis++) {
        for (size_t slot = 0; slot < count; slot++)
            ratio[axis][slot] = 1 + 2 * e[axis][slot];
    }
}

TALUS_INLINE void resize(const struct shape_context *context, const struct particle_block *block,
                         bool by_volume, struct domain_findings *findings)
{
    const size_t axes = context->particles->component_count[PARTICLE_DOMAIN] / 2;
    const size_t slots = (size_t)block->row_count * LANE_COUNT;
    assert(axes >= 1 && axes <= 3);
    for (size_t begin = 0; begin < slots; begin += BATCH) {
        const size_t count = slots - begin < BATCH ? slots - begin : BATCH;
        real h[9][BATCH], e[6][BATCH], ratio[3][BATCH];
        load_gradient(context, block, begin, count, axes, h);
        green_strain(count, h, e);
        if (by_volume) {
            find_stretched(block, begin, count, e, findings);
            volume_ratios(count, axes, h, ratio);
        } else {
            stretch_ratios(count, axes, e, ratio);
        }
        set_lengths(context, block, begin, count, axes, ratio, findings);
    }
}

static void resize_by_volume(const struct shape_context *context,
                             const struct particle_block *block, struct domain_findings *findings)
{
    resize(context, block, true, findings);
}

static void resize_by_stretch(const struct shape_context *context,
                              const struct particle_block *block, struct domain_findings *findings)
{
    resize(context, block, false, findings);
}

static const struct shape_domain domain = {
    .component_count = component_count,
    .needs_gradient = true,
    .initialise = initialise,
    .resize = {resize_by_volume, resize_by_stretch},
};

const struct shape shape_gimp_scaled = {
    .name = "gimp_scaled",
    .reference = "Andersen and Andersen 2012, eq. 28; Charlton, Coombs and Augarde 2017",
    .summary = "gimp with boxes that follow the volume or the stretch of their particles; for "
               "moderate deformation",
    .courant_limit = {1.26, 0.58, 1.26},
    .reach = 1,
    .domain = &domain,
    .locks = true,
    .kernels = {&gimp_kernels_1, &gimp_kernels_2, &gimp_kernels_3},
};

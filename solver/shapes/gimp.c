/* SPDX-License-Identifier: Apache-2.0 */
/* Uniform generalised interpolation: hat functions averaged over a box of fixed size around the
 * particle. With P the integral of a hat, N = (P(s + l) - P(s - l)) / 2l for every half length l,
 * so the two differences of a node need no cases but the ends of the hat. */
#include "shapes/gimp.h"

#include "shapes/wide_shape.h"

/* Half lengths below this count as this: empty slots have none. */
#define GIMP_HALF_MIN (1.0 / 1024.0)

/* s + l and s - l of the four nodes, cut at the ends of the hat, are
 *   node -1:  1, 1 - q;    0:  a, b;    1:  c, d;    2:  p - 1, -1. */
TALUS_INLINE void gimp_weights(lanes x, lanes half, lane_mask odd, lanes w[WIDE_NODES],
                               lanes dw[WIDE_NODES])
{
    (void)odd;
    const lanes zero = {0}, one = lanes_splat(1);
    const lanes l = lanes_maximum(half, lanes_splat(GIMP_HALF_MIN));
    const lanes inverse = 0.5 / l;
    const lanes q = lanes_maximum(l - x - 0.5, zero), p = lanes_maximum(l + x - 0.5, zero);
    const lanes a = lanes_minimum(x + 0.5 + l, one), b = x + 0.5 - l;
    const lanes c = x - 0.5 + l, d = lanes_maximum(x - 0.5 - l, -one);
    const lanes size_b = lanes_absolute(b), size_c = lanes_absolute(c);
    w[0] = 0.5 * q * q * inverse;
    w[1] = (a - b - 0.5 * (a * a - b * size_b)) * inverse;
    w[2] = (c - d - 0.5 * (c * size_c + d * d)) * inverse;
    w[3] = 0.5 * p * p * inverse;
    dw[0] = -q * inverse;
    dw[1] = (size_b - a) * inverse;
    dw[2] = -(size_c + d) * inverse;
    dw[3] = p * inverse;
}

#define WIDE_KERNELS gimp_kernels
#define WIDE_WEIGHTS gimp_weights
#define WIDE_USES_DOMAIN 1
#define WIDE_FOLDS 1
#define DIMENSION 1
#include "shapes/wide_kernel.h"
#undef DIMENSION
#define DIMENSION 2
#include "shapes/wide_kernel.h"
#undef DIMENSION
#define DIMENSION 3
#include "shapes/wide_kernel.h"
#undef DIMENSION

static uint32_t component_count(size_t axis_count)
{
    return (uint32_t)axis_count;
}

static void initialise(size_t axis_count, const double size[3], real *domain)
{
    for (size_t axis = 0; axis < axis_count; axis++)
        domain[axis] = (real)(0.5 * size[axis]);
}

/* Sizes stay; those that are too large are found at the start. */
static void cap(const struct shape_context *context, const struct particle_block *block,
                struct domain_findings *findings)
{
    const uint32_t axes = context->particles->component_count[PARTICLE_DOMAIN];
    const size_t count = (size_t)block->row_count * LANE_COUNT;
    for (size_t slot = 0; slot < count; slot++) {
        bool longer = false;
        for (uint32_t axis = 0; axis < axes; axis++) {
            real *half = particle_values(context->particles, block, PARTICLE_DOMAIN, axis) + slot;
            longer = longer || *half > (real)GIMP_HALF_MAX;
            *half = *half > (real)GIMP_HALF_MAX ? (real)GIMP_HALF_MAX : *half;
        }
        if (longer && findings->capped++ == 0)
            findings->capped_particle = block->id[slot];
    }
}

static const struct shape_domain domain = {
    .component_count = component_count,
    .initialise = initialise,
    .resize = {cap, cap},
};

const struct shape shape_gimp = {
    .name = "gimp",
    .reference = "Bardenhagen and Kober 2004; Andersen and Andersen 2012, sec. 2",
    .summary = "hat functions averaged over boxes of fixed size: no noise where particles cross "
               "cells, up to three nodes an axis",
    /* Those of linear functions, times the ratio of the spectral radii of free bodies of one to
     * three cells and one to four particles an axis, solid and fluid, at several places of the
     * grid. */
    .courant_limit = {1.26, 0.58, 1.26},
    .reach = 1,
    .domain = &domain,
    .locks = true,
    .kernels = {&gimp_kernels_1, &gimp_kernels_2, &gimp_kernels_3},
};

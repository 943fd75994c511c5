/* SPDX-License-Identifier: Apache-2.0 */
/* Convected particle domain interpolation: a particle is a parallelogram (parallelepiped) that
 * deforms with it, over which hat functions vary linearly between its corners. A domain that
 * reaches more than CPDI_REACH cells from its particle is shortened for the interpolation, not in
 * itself: it would spread one particle over many nodes and past other bodies. */
#include "shapes/cpdi.h"

#include "base/inline.h"
#include "math/tensor.h"
#include "state/wide_window.h"

#include <math.h>
#include <string.h>

enum { POINT_REACH = CPDI_REACH };

#define DIMENSION 1
#include "shapes/point_kernel.h"
#undef DIMENSION
#define DIMENSION 2
#include "shapes/point_kernel.h"
#undef DIMENSION
#define DIMENSION 3
#include "shapes/point_kernel.h"
#undef DIMENSION

uint32_t cpdi_component_count(size_t axis_count)
{
    return 2 * (uint32_t)(axis_count * axis_count);
}

void cpdi_initialise(size_t axis_count, const double size[3], real *domain)
{
    const size_t entries = axis_count * axis_count;
    for (size_t entry = 0; entry < entries; entry++) {
        const size_t edge = entry / axis_count, axis = entry % axis_count;
        domain[entry] = domain[entries + entry] = edge == axis ? (real)(0.5 * size[axis]) : 0;
    }
}

/* One component of r = r0 + (F - I) r0 of all slots. */
static void convect_component(const struct shape_context *context,
                              const struct particle_block *block, uint32_t axes, uint32_t edge,
                              uint32_t axis)
{
    const struct particle_layout *layout = context->particles;
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    real *r = particle_values(layout, block, PARTICLE_DOMAIN, axes * edge + axis);
    const real *start =
        particle_values(layout, block, PARTICLE_DOMAIN, axes * axes + axes * edge + axis);
    memcpy(r, start, slot_count * sizeof *r);
    for (uint32_t along = 0; along < axes; along++) {
        const real *h = particle_values(layout, block, PARTICLE_GRADIENT, axes * axis + along);
        const real *from =
            particle_values(layout, block, PARTICLE_DOMAIN, axes * axes + axes * edge + along);
        const real ratio = context->cell_ratio[along][axis];
        for (size_t slot = 0; slot < slot_count; slot++)
            r[slot] += ratio * h[slot] * from[slot];
    }
}

void cpdi_resize(const struct shape_context *context, const struct particle_block *block,
                 struct domain_findings *findings)
{
    const uint32_t axes = cpdi_axis_count(context);
    const size_t slot_count = (size_t)block->row_count * LANE_COUNT;
    for (uint32_t entry = 0; entry < axes * axes; entry++)
        convect_component(context, block, axes, entry / axes, entry % axes);
    for (size_t slot = 0; slot < slot_count; slot++) {
        bool longer = false;
        for (uint32_t axis = 0; axis < axes; axis++)
            longer = longer || cpdi_reach(context, block, axes, axis, slot) > POINT_REACH;
        if (longer && block->id[slot] != PARTICLE_NONE && findings->capped++ == 0)
            findings->capped_particle = block->id[slot];
    }
}

static const struct shape_domain domain = {
    .component_count = cpdi_component_count,
    .needs_gradient = true,
    .initialise = cpdi_initialise,
    .resize = {cpdi_resize, cpdi_resize},
};

const struct shape shape_cpdi = {
    .name = "cpdi",
    .reference = "Sadeghirad, Brannon and Burghardt 2011; Mast 2013, sec. 2.4.7",
    .summary = "hat functions averaged over domains that stretch and shear with their particles: "
               "for large deformation; two to ten times the cost of linear",
    .courant_limit = {1.24, 0.49, 1.24},
    .reach = CPDI_REACH,
    .domain = &domain,
    .locks = true,
    .kernels = {&cpdi_kernels_1, &cpdi_kernels_2, &cpdi_kernels_3},
};

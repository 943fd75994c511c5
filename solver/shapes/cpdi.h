/* SPDX-License-Identifier: Apache-2.0 */
/* What both kinds of CPDI share. PARTICLE_DOMAIN holds the half edges of the particle's domain, in
 * cell widths: r [edge][axis] as they are, then as they were in the beginning. */
#ifndef TALUS_CPDI_H
#define TALUS_CPDI_H

#include "shapes/shape.h"

/* Cells beyond its own over which a domain may reach. */
enum { CPDI_REACH = 2 };

/* Per dimension: 1, 2, 3 axes. */
extern const struct shape_kernels cpdi_kernels_1, cpdi_kernels_2, cpdi_kernels_3;

uint32_t cpdi_component_count(size_t axis_count);
void cpdi_initialise(size_t axis_count, const double size[3], real *domain);
/* r = F r0 (Mast 2013, sec. 2.4.7). Counts the domains that reach too far. */
void cpdi_resize(const struct shape_context *context, const struct particle_block *block,
                 struct domain_findings *findings);
/* Axes of the scene, out of what is stored. */
static inline uint32_t cpdi_axis_count(const struct shape_context *context)
{
    const uint32_t components = context->particles->component_count[PARTICLE_DOMAIN];
    return components == 2 ? 1 : components == 8 ? 2 : 3;
}

/* How far the domain of a slot reaches from the particle along an axis, in cell widths. */
static inline real cpdi_reach(const struct shape_context *context,
                              const struct particle_block *block, size_t axis_count, size_t axis,
                              size_t slot)
{
    real reach = 0;
    for (size_t edge = 0; edge < axis_count; edge++) {
        const real r = particle_values(context->particles, block, PARTICLE_DOMAIN,
                                       (uint32_t)(axis_count * edge + axis))[slot];
        reach += r < 0 ? -r : r;
    }
    return reach;
}

#endif

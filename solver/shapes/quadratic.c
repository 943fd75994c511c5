/* SPDX-License-Identifier: Apache-2.0 */
/* Quadratic Lagrange functions of elements with three nodes an axis (9 in 2D, 27 in 3D). The nodes
 * in the middle of a scene's cells are nodes of the solver's grid, whose cells are half as wide: an
 * element is two of them, an even one and an odd one. No support leaves its element, so that walls
 * along the lines of the scene's grid need no fold. */
#include "shapes/wide_shape.h"

TALUS_INLINE void quadratic_weights(lanes x, lanes half, lane_mask odd, lanes w[WIDE_NODES],
                                    lanes dw[WIDE_NODES])
{
    (void)half;
    const lanes zero = {0};
    /* From the middle of the element, in widths of its halves. */
    const lanes xi = x + lanes_select(odd, lanes_splat(0.5), lanes_splat(-0.5));
    const lanes low = 0.5 * xi * (xi - 1), high = 0.5 * xi * (xi + 1), middle = 1 - xi * xi;
    const lanes slope_low = xi - 0.5, slope_high = xi + 0.5, slope_middle = -2 * xi;
    w[0] = lanes_select(odd, low, zero);
    w[1] = lanes_select(odd, middle, low);
    w[2] = lanes_select(odd, high, middle);
    w[3] = lanes_select(odd, zero, high);
    dw[0] = lanes_select(odd, slope_low, zero);
    dw[1] = lanes_select(odd, slope_middle, slope_low);
    dw[2] = lanes_select(odd, slope_high, slope_middle);
    dw[3] = lanes_select(odd, zero, slope_high);
}

#define WIDE_KERNELS quadratic_kernels
#define WIDE_WEIGHTS quadratic_weights
#define WIDE_USES_DOMAIN 0
#define WIDE_FOLDS 0
#define DIMENSION 1
#include "shapes/wide_kernel.h"
#undef DIMENSION
#define DIMENSION 2
#include "shapes/wide_kernel.h"
#undef DIMENSION
#define DIMENSION 3
#include "shapes/wide_kernel.h"
#undef DIMENSION

const struct shape shape_quadratic = {
    .name = "quadratic",
    .reference = "Mast 2013, sec. B.2.2",
    .summary = "quadratic elements of 9 or 27 nodes, for small displacements of bodies of whole "
               "cells: refused where a lumped mass is not positive",
    /* In cells of half the width: those of linear functions, times the ratio of the spectral radii
     * of bodies of one to three full elements with two to four particles an axis. */
    .courant_limit = {0.70, 0.51, 0.70},
    .reach = 1,
    .halves_cells = true,
    .may_lump_negative = true,
    .kernels = {&quadratic_kernels_1, &quadratic_kernels_2, &quadratic_kernels_3},
};

/* SPDX-License-Identifier: Apache-2.0 */
/* Quadratic B-splines. Of the knots, which lie in the middle between the nodes, one is the centre
 * of the cell: with p and m the parts of x above and below it the weights are polynomials. */
#include "shapes/wide_shape.h"

TALUS_INLINE void bspline2_weights(lanes x, lanes half, lane_mask odd, lanes w[WIDE_NODES],
                                   lanes dw[WIDE_NODES])
{
    (void)half, (void)odd;
    const lanes zero = {0};
    const lanes p = lanes_maximum(x, zero), m = x - p;
    w[0] = 0.5 * m * m;
    w[3] = 0.5 * p * p;
    w[1] = 0.5 - x + w[3] - 2 * w[0];
    w[2] = 0.5 + x + w[0] - 2 * w[3];
    dw[0] = m;
    dw[1] = p - 2 * m - 1;
    dw[2] = 1 + m - 2 * p;
    dw[3] = p;
}

#define WIDE_KERNELS bspline2_kernels
#define WIDE_WEIGHTS bspline2_weights
#define WIDE_USES_DOMAIN 0
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

const struct shape shape_bspline2 = {
    .name = "bspline2",
    .reference = "Steffen, Kirby and Berzins 2008; Mast 2013, sec. 8.3.2",
    .summary =
        "quadratic B-splines: smooth forces where particles cross cells, three nodes an axis",
    /* Those of linear functions, times the ratio of the spectral radii of free bodies of one to
     * three cells and one to four particles an axis, solid and fluid, at several places of the
     * grid. */
    .courant_limit = {1.45, 0.63, 1.45},
    .reach = 1,
    .kernels = {&bspline2_kernels_1, &bspline2_kernels_2, &bspline2_kernels_3},
};

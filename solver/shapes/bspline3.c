/* SPDX-License-Identifier: Apache-2.0 */
/* Cubic B-splines: the knots are the nodes, so that in a cell every weight is one cubic. */
#include "shapes/wide_shape.h"

TALUS_INLINE void bspline3_weights(lanes x, lanes half, lane_mask odd, lanes w[WIDE_NODES],
                                   lanes dw[WIDE_NODES])
{
    (void)half, (void)odd;
    const lanes t = 0.5 + x, u = 0.5 - x; /* from the lower, from the upper node */
    const lanes tt = t * t, uu = u * u;
    w[0] = uu * u * (real)(1.0 / 6.0);
    w[1] = (real)(2.0 / 3.0) - tt * (1 - 0.5 * t);
    w[2] = (real)(2.0 / 3.0) - uu * (1 - 0.5 * u);
    w[3] = tt * t * (real)(1.0 / 6.0);
    dw[0] = -0.5 * uu;
    dw[1] = t * (1.5 * t - 2);
    dw[2] = u * (2 - 1.5 * u);
    dw[3] = 0.5 * tt;
}

#define WIDE_KERNELS bspline3_kernels
#define WIDE_WEIGHTS bspline3_weights
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

const struct shape shape_bspline3 = {
    .name = "bspline3",
    .reference = "Steffen, Kirby and Berzins 2008; Mast 2013, sec. 8.3.2",
    .summary = "cubic B-splines: the smoothest, four nodes an axis",
    /* Those of linear functions, times the ratio of the spectral radii of free bodies of one to
     * three cells and one to four particles an axis, solid and fluid, at several places of the
     * grid. */
    .courant_limit = {1.67, 0.77, 1.67},
    .reach = 1,
    .kernels = {&bspline3_kernels_1, &bspline3_kernels_2, &bspline3_kernels_3},
};

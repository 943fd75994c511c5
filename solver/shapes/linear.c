/* SPDX-License-Identifier: Apache-2.0 */
/* Tensor product of hat functions. On a cell with coordinate x in -1/2..1/2 the two functions of an
 * axis are 1/2 - x and 1/2 + x, so a nodal field is a polynomial in 1, x, y, xy, z, ... whose
 * coefficients follow from the corner values by (lo + hi) / 2 and hi - lo on each axis; the
 * transposed transform expands moments to nodes. */
#include "math/tensor.h"
#include "shapes/shape.h"

#define DIMENSION 1
#include "shapes/linear_kernel.h"
#undef DIMENSION
#define DIMENSION 2
#include "shapes/linear_kernel.h"
#undef DIMENSION
#define DIMENSION 3
#include "shapes/linear_kernel.h"
#undef DIMENSION

const struct shape shape_linear = {
    .name = "linear",
    .reference = "Mast 2013, eq. 2.22-2.24; Andersen and Andersen 2012, sec. 2",
    .summary =
        "piecewise linear hat functions, the cheapest kernel; noisy where particles cross cells",
    /* Spectral radius of the step of full cells, the least favourable of 1-D to 3-D, solid and
     * fluid, with one to four particles per cell and axis. */
    .courant_limit = {1.26, 0.63, 1.26},
    .light_nodes = true,
    .locks = true,
    .kernels = {&linear_kernels_1, &linear_kernels_2, &linear_kernels_3},
};

/* SPDX-License-Identifier: Apache-2.0 */
/* Linear fits over the particles of a cell (Mast 2013, sec. 4.3.2 and 4.4.1, eq. 4.17-4.28). The
 * mass-weighted least squares of the source are one scalar fit for each component:
 *   q^h(x) = qbar + a . (x - xbar),  a = C^-1 sum m (x - xbar) q,  C = sum m (x - xbar)(x - xbar)^T
 * about the centre of mass xbar. A lane is a cell, so a cell needs no horizontal sums. */
#ifndef TALUS_CELL_FIT_H
#define TALUS_CELL_FIT_H

#include "state/lanes.h"

#include <stdbool.h>
#include <stddef.h>

/* Smallest eigenvalue of C over (mass x cell width^2) with which a linear fit is trusted. Where
 * particles lie near one line (one plane in 3D) or are too few, only the volumetric part is fitted,
 * as a constant (Mast 2013, sec. 4.4.6, which names no number). */
#define LINEAR_FIT_LEAST_SPREAD 1e-4

/* How the particles of the cells of a block lie. Positions in cell widths. */
struct cell_fit {
    size_t count, axis_count; /* slots */
    const real *weight;       /* [count] mass; 0: takes no part, and keeps its values */
    const real *position[3];  /* [axis_count][count] */
    lanes inverse_mass;       /* 1 where a cell is empty */
    lanes centroid[3];
    lanes inverse[3][3]; /* of C / mass; 0 where it is singular */
    lane_mask singular;  /* empty cells too */
    size_t fall_backs;   /* cells with particles whose C is singular */
};

/* Inverse of symmetric C[axis_count][axis_count]; 0 where its smallest eigenvalue is not above
 * LINEAR_FIT_LEAST_SPREAD, which are the lanes returned. */
lane_mask fit_inverse(size_t axis_count, lanes C[3][3], lanes inverse[3][3]);

void cell_fit_init(struct cell_fit *fit, size_t count, size_t axis_count, const real *weight,
                   const real *const position[3]);

/* values[count] <- linear fit; the mean where C is singular. */
void cell_fit_scalar(const struct cell_fit *fit, real *values);

/* Fits a symmetric tensor: normal components linear, shears constant. `normal_count`: 3, or 2 in
 * plane stress, whose zz stays as it is. The trace is linear too, or constant
 * (`constant_trace`), or `trace`[count] if that is given. Where C is singular the trace is the
 * mean (or `trace`), and the deviator stays as it is. */
void cell_fit_tensor(const struct cell_fit *fit, size_t component_count, size_t normal_count,
                     bool constant_trace, const real *trace, real *const tensor[6]);

#endif

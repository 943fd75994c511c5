/* SPDX-License-Identifier: Apache-2.0 */
/* Cell-based volumetric anti-locking (Mast 2013, sec. 4.3.1, eq. 4.25-4.28, Table 4.1): the mean
 * over the particles of a cell, weighted by mass, replaces the volumetric part of the trial elastic
 * strain, and after the constitutive update that of the stress. A lane is a cell, so the averages
 * need no horizontal sums. */
#ifndef TALUS_ANTI_LOCKING_H
#define TALUS_ANTI_LOCKING_H

#include "math/real.h"

#include <stddef.h>

/* values[count] <- weighted mean over the rows of each lane; lanes without weight keep theirs.
 * weight 0 marks slots that take no part (empty, or another material): they stay as they are. */
void cell_average(size_t count, const real *weight, real *values);

#endif

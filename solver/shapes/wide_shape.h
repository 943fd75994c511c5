/* SPDX-License-Identifier: Apache-2.0 */
/* What every file of a wide shape includes once, before the kernels. */
#ifndef TALUS_WIDE_SHAPE_H
#define TALUS_WIDE_SHAPE_H

#include "base/inline.h"
#include "math/tensor.h"
#include "shapes/shape.h"
#include "state/wide_window.h"

#include <string.h>

/* Nodes along an axis that a particle of a cell can reach, and rows of particles whose weights are
 * worked out together. */
enum { WIDE_NODES = 4, WIDE_CHUNK = 8 };

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* The strain measures of log_strain.h for tensors with xx yy zz xy only, and with xx yy zz only:
 * chunks as tensor_chunk.h defines them. The square of a traceless tensor D in the plane is j I, so
 * every function of it is one of j times D and one times I; no eigenvalue is needed, and no range
 * is left to other ways of computing. */
#ifndef TALUS_PLANE_STRAIN_H
#define TALUS_PLANE_STRAIN_H

#include "math/tensor_chunk.h"

tensor_chunk_function plane_log;
tensor_chunk_function plane_log_diagonal;
tensor_chunk_function plane_exp;
tensor_chunk_function plane_exp_diagonal;

#endif

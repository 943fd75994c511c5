/* SPDX-License-Identifier: Apache-2.0 */
/* Between the two forms of the elastic strain at finite strain: e = (b - I)/2, which particles
 * store (b itself would lose half of the digits of a strain of 1e-8), and the Hencky strain
 * 1/2 ln b, which materials work on (Mast 2013, table 3.4). */
#ifndef TALUS_LOG_STRAIN_H
#define TALUS_LOG_STRAIN_H

#include "math/real.h"

#include <stddef.h>

/* strain[] = 1/2 ln(I + 2 e[]) for `count` slots. component_count: 3 (xx yy zz), 4 (+ xy) or 6 (+
 * yz xz); arrays beyond it are not touched and count as zero. `strain` may be `e`. Returns the
 * number of slots whose b is not positive definite (or not finite): all their components are NAN.
 *
 * Any count and alignment is right; multiples of 4 slots are fastest. Up to a norm of 0.05 series
 * serve, of which a batch takes the shortest that is enough for its 64 slots, then a closed form,
 * all in SIMD; in three dimensions a slot whose b has an eigenvalue under a tenth of their mean is
 * done by itself, some 30 times slower. The error is some 1e-15 of the norm of the result, repeated
 * eigenvalues included; in b that spans decades, of the largest over the smallest eigenvalue times
 * 1e-16, as every method that starts from components. */
size_t log_strain_batch(size_t count, size_t component_count, real *const e[6],
                        real *const strain[6]);

/* The inverse: e[] = (exp(2 strain[]) - I)/2, same conventions; `e` may be `strain`. Slots of a
 * norm above 10 are done one by one. */
void exp_strain_batch(size_t count, size_t component_count, real *const strain[6],
                      real *const e[6]);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Between the two forms of the elastic strain at finite strain: e = (b - I)/2, which particles
 * store (b itself would lose half of the digits of a strain of 1e-8), and the Hencky strain
 * 1/2 ln b, which materials work on (Mast 2013, table 3.4). */
#ifndef TALUS_LOG_STRAIN_H
#define TALUS_LOG_STRAIN_H

#include <stddef.h>

/* strain[] = 1/2 ln(I + 2 e[]) for `count` slots. component_count: 3 (xx yy zz), 4 (+ xy) or 6 (+
 * yz xz); arrays beyond it are not touched and count as zero. `strain` may be `e`. The relative
 * error is below 1e-14 of the norm for any strain, repeated eigenvalues included. Returns the
 * number of slots whose b is not positive definite (or not finite): all their components are NAN.
 * Slots up to a strain of about 0.1 run in SIMD, larger ones one by one. */
size_t log_strain_batch(size_t count, size_t component_count, double *const e[6],
                        double *const strain[6]);

/* The inverse: e[] = (exp(2 strain[]) - I)/2, same conventions; `e` may be `strain`. */
void exp_strain_batch(size_t count, size_t component_count, double *const strain[6],
                      double *const e[6]);

#endif

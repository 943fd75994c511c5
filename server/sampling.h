/* SPDX-License-Identifier: Apache-2.0 */
/* Points of the unit cube [0, 1)^d, the same on every machine: integers only until the last step.
 */
#ifndef TALUS_SAMPLING_H
#define TALUS_SAMPLING_H

#include <stddef.h>
#include <stdint.h>

/* SplitMix64 (Steele, Lea and Flood 2014): the state is the seed; each call gives 64 random bits.
 */
uint64_t sampling_random(uint64_t *state);

/* Latin hypercube (McKay, Beckman and Conover 1979): of `count` points, points[point * dimensions +
 * axis], each axis has exactly one in each of `count` equal strata, at random within it. Strata are
 * permuted by a shuffle of Fisher and Yates, one axis after the other, from SplitMix64. */
void sampling_latin_hypercube(uint64_t seed, size_t count, size_t dimensions, double *points);

enum { SOBOL_DIMENSION_MAX = 64, SOBOL_BITS = 32 };

/* The first `count` (at most 2^32) points of the Sobol sequence in `dimensions` (1 to
 * SOBOL_DIMENSION_MAX) with the direction numbers of Joe and Kuo (2008), in the order of Gray codes
 * (Antonov and Saleev 1979), the origin first. A seed other than 0 shifts the points: each axis is
 * XORed with 32 random bits of its own, which keeps every property of equal distribution. */
void sampling_sobol(uint64_t seed, size_t count, size_t dimensions, double *points);

#endif

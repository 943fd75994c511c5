/* SPDX-License-Identifier: Apache-2.0 */
#include "sampling.h"

#include <assert.h>

uint64_t sampling_random(uint64_t *state)
{
    uint64_t mixed = *state += UINT64_C(0x9e3779b97f4a7c15);
    mixed = (mixed ^ (mixed >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    mixed = (mixed ^ (mixed >> 27)) * UINT64_C(0x94d049bb133111eb);
    return mixed ^ (mixed >> 31);
}

/* A random whole number below a limit, all equally likely: the remainder of the first random number
 * that lies in a whole number of periods. */
static uint64_t random_below(uint64_t *state, uint64_t limit)
{
    uint64_t beyond = (UINT64_MAX - limit + 1) % limit; /* 2^64 modulo the limit */
    uint64_t random = sampling_random(state);
    while (random < beyond)
        random = sampling_random(state);
    return random % limit;
}

void sampling_latin_hypercube(uint64_t seed, size_t count, size_t dimensions, double *points)
{
    uint64_t state = seed;
    for (size_t axis = 0; axis < dimensions; axis++) {
        for (size_t point = 0; point < count; point++)
            points[point * dimensions + axis] = (double)point;
        for (size_t point = count; point > 1; point--) {
            size_t other = (size_t)random_below(&state, point);
            double *left = &points[(point - 1) * dimensions + axis];
            double *right = &points[other * dimensions + axis];
            double kept = *left;
            *left = *right;
            *right = kept;
        }
        for (size_t point = 0; point < count; point++) {
            double within = (double)(sampling_random(&state) >> 11) * 0x1p-53;
            double *value = &points[point * dimensions + axis];
            double stratum = *value;
            *value = (stratum + within) / (double)count;
            if (*value >= (stratum + 1.0) / (double)count) /* rounded up to the next stratum */
                *value = stratum / (double)count;
        }
    }
}

struct directions {
    unsigned int degree, inner;
    uint32_t first[12];
};

#define DIRECTIONS(degree, inner, ...) {degree, inner, {__VA_ARGS__}},
static const struct directions table[SOBOL_DIMENSION_MAX - 1] = {
#include "sobol_directions.def"
};
#undef DIRECTIONS

/* The direction numbers of an axis as fractions of 2^32 (Joe and Kuo 2008, eq. 2 and 3). */
static void directions_make(size_t axis, uint32_t direction[SOBOL_BITS])
{
    if (axis == 0) { /* van der Corput */
        for (unsigned int bit = 0; bit < SOBOL_BITS; bit++)
            direction[bit] = UINT32_C(1) << (31 - bit);
        return;
    }
    const struct directions *given = &table[axis - 1];
    const unsigned int degree = given->degree;
    for (unsigned int bit = 0; bit < degree; bit++)
        direction[bit] = given->first[bit] << (31 - bit);
    for (unsigned int bit = degree; bit < SOBOL_BITS; bit++) {
        direction[bit] = direction[bit - degree] ^ (direction[bit - degree] >> degree);
        for (unsigned int term = 1; term < degree; term++) {
            if (((given->inner >> (degree - 1 - term)) & 1U) != 0)
                direction[bit] ^= direction[bit - term];
        }
    }
}

void sampling_sobol(uint64_t seed, size_t count, size_t dimensions, double *points)
{
    uint64_t state = seed;
    assert(dimensions >= 1 && dimensions <= SOBOL_DIMENSION_MAX);
    for (size_t axis = 0; axis < dimensions; axis++) {
        uint32_t direction[SOBOL_BITS];
        uint32_t value = seed == 0 ? 0 : (uint32_t)(sampling_random(&state) >> 32);
        directions_make(axis, direction);
        for (size_t point = 0; point < count; point++) {
            points[point * dimensions + axis] = (double)value * 0x1p-32;
            unsigned int zeros = 0; /* trailing ones of the point's number: what Gray codes flip */
            while (((point >> zeros) & 1U) != 0)
                zeros++;
            value ^= direction[zeros % SOBOL_BITS];
        }
    }
}

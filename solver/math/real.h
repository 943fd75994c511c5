/* SPDX-License-Identifier: Apache-2.0 */
/* The number that particles, nodes and kernels compute with: double, or float in the build for
 * single precision (TALUS_SINGLE). Scenes, clocks, sums over many particles and everything that
 * leaves the solver are double in both. */
#ifndef TALUS_REAL_H
#define TALUS_REAL_H

#include <math.h>

#ifdef TALUS_SINGLE
typedef float real;
#define REAL_EPSILON 0x1p-23f
#else
typedef double real;
#define REAL_EPSILON 0x1p-52
#endif

static inline real real_sqrt(real x)
{
#ifdef TALUS_SINGLE
    return sqrtf(x);
#else
    return sqrt(x);
#endif
}

static inline real real_absolute(real x)
{
#ifdef TALUS_SINGLE
    return fabsf(x);
#else
    return fabs(x);
#endif
}

#endif

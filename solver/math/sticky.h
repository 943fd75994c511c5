/* SPDX-License-Identifier: Apache-2.0 */
/* Extremes that keep a NAN: fmin and fmax drop it, and a plain comparison drops it with the next
 * value. What health looks at must not lose the only particle that has gone bad. */
#ifndef TALUS_STICKY_H
#define TALUS_STICKY_H

static inline double sticky_maximum(double a, double b)
{
    return a >= b || a != a ? a : b;
}

static inline double sticky_minimum(double a, double b)
{
    return a <= b || a != a ? a : b;
}

#endif

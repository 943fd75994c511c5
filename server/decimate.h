/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_DECIMATE_H
#define TALUS_DECIMATE_H

#include <stdbool.h>
#include <stddef.h>

/* Thins a curve of `count` points in place to at most `max_points` (at least 4) so that its peaks
 * stay: the points between the first and the last are split into buckets of equal count, and of
 * each the smallest and the largest value are kept, in the order of time. NaN counts as neither.
 * Returns the new count. */
size_t decimate(double *time, double *value, size_t count, size_t max_points);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Measured durations and their percentiles. */
#ifndef TALUS_LOADGEN_SAMPLES_H
#define TALUS_LOADGEN_SAMPLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* [s]; zeroed is empty. */
struct samples {
    double *values;
    size_t count, capacity;
    bool failed; /* out of memory: what is here is not all */
};

void samples_add(struct samples *samples, double value);
/* Writes "p50_ms":..,"p90_ms":..,"p99_ms":..,"max_ms":.. (null without samples); sorts them. */
void samples_write(struct samples *samples, FILE *stream);
void samples_release(struct samples *samples);

#endif

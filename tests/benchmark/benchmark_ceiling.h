/* SPDX-License-Identifier: Apache-2.0 */
/* What the machine can do: arithmetic and memory, with the vectors of this instruction set. Rates
 * of a core, the mean over threads that work at the same time, each one measured by its own
 * processor time. */
#ifndef BENCHMARK_CEILING_H
#define BENCHMARK_CEILING_H

#include <stdbool.h>

struct ceiling {
    double *memory; /* three arrays of 64 MiB a thread; owned */
    int threads;    /* at most */
};

enum ceiling_kind {
    CEILING_DOUBLE,   /* independent a = a b + c in registers [GFLOP/s], two operations each */
    CEILING_FLOAT,    /* the same in single precision */
    CEILING_TRIAD,    /* a = b + s c [GB/s], 24 bytes an element */
    CEILING_IN_PLACE, /* a = s a [GB/s], 16 bytes an element */
    CEILING_COUNT
};

/* False without memory. */
bool ceiling_create(struct ceiling *ceiling, int threads);
void ceiling_release(struct ceiling *ceiling);
/* The best of so many tries; one takes some milliseconds. threads <= ceiling->threads. */
double ceiling_measure(const struct ceiling *ceiling, enum ceiling_kind kind, int threads,
                       int tries);

#endif

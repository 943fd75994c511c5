/* SPDX-License-Identifier: Apache-2.0 */
/* Proof that a body is not at rest: a smaller one of the same setup, with fields to look at. */
#ifndef BENCHMARK_WITNESS_H
#define BENCHMARK_WITNESS_H

#include "benchmark_measure.h"

struct benchmark_witness {
    double strain;  /* root mean square of the strain increment of a step (norm of the tensor) */
    double plastic; /* share of the particles that yield in a step */
};

/* Over the steps of one repeat. False if nothing could be measured (the reason is on stderr). */
bool benchmark_witness_call(const struct benchmark_setup *setup, size_t particles, size_t steps,
                            struct benchmark_witness *witness);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Floating-point operations of a step, as count_operations.py has counted them in the instructions
 * that the program executed. */
#ifndef BENCHMARK_OPERATIONS_H
#define BENCHMARK_OPERATIONS_H

#include "benchmark_case.h"

/* Per slot walked and step, a fused multiply-add as two; NAN if nobody has counted. */
double benchmark_operations(const struct benchmark_setup *setup);

#endif

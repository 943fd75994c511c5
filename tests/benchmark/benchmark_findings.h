/* SPDX-License-Identifier: Apache-2.0 */
/* What follows from the rows: shares, costs and ratios, one line each. */
#ifndef BENCHMARK_FINDINGS_H
#define BENCHMARK_FINDINGS_H

#include "benchmark_suite.h"

#include <stdio.h>

/* Every line begins with `prefix`. */
void benchmark_findings_write(const struct benchmark_suite *suite, const char *prefix, FILE *file);

#endif

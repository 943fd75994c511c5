/* SPDX-License-Identifier: Apache-2.0 */
/* Results for people and for files. */
#ifndef BENCHMARK_REPORT_H
#define BENCHMARK_REPORT_H

#include "benchmark_measure.h"

/* Everything about one measurement, on stdout. */
void benchmark_report_one(const struct benchmark_setup *setup,
                          const struct benchmark_result *result);

#endif

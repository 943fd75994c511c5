/* SPDX-License-Identifier: Apache-2.0 */
/* One measurement in words. */
#ifndef BENCHMARK_REPORT_H
#define BENCHMARK_REPORT_H

#include "benchmark_suite.h"

/* Everything about one measurement, on stdout. */
void benchmark_report_one(const struct benchmark_row *row);

#endif

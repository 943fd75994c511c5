/* SPDX-License-Identifier: Apache-2.0 */
/* The results for people. */
#ifndef BENCHMARK_TABLE_H
#define BENCHMARK_TABLE_H

#include "benchmark_suite.h"

/* Measurements, stages and findings, on stdout. */
void benchmark_table_print(const struct benchmark_suite *suite);

#endif

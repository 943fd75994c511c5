/* SPDX-License-Identifier: Apache-2.0 */
/* The results file: comments about the machine, one line a measurement, findings as comments. */
#ifndef BENCHMARK_CSV_H
#define BENCHMARK_CSV_H

#include "benchmark_suite.h"

/* Writes path, whole or not at all. False after a message. */
bool benchmark_csv_write(const struct benchmark_suite *suite, const char *path);

#endif

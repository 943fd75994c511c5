/* SPDX-License-Identifier: Apache-2.0 */
/* The benchmark is built once per instruction set and precision; the plain program starts the one
 * that is wanted. */
#ifndef BENCHMARK_ISA_H
#define BENCHMARK_ISA_H

#include <stdbool.h>

/* Name of the instruction set of this program. */
const char *benchmark_isa(void);
/* Whether this program computes in single precision. */
bool benchmark_is_single(void);

/* Becomes the program for the instruction set `wanted` (NULL: the best that the processor has),
 * with threads bound to cores and waiting as those of talus-worker do. Returns 0 if this is the
 * program already; -1 if there is none. */
int benchmark_isa_switch(const char *wanted, bool single, char **arguments);

#endif

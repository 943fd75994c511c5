/* SPDX-License-Identifier: Apache-2.0 */
/* The benchmark is built once per instruction set; the plain program starts the best one. */
#ifndef BENCHMARK_ISA_H
#define BENCHMARK_ISA_H

/* Name of the instruction set of this program. */
const char *benchmark_isa(void);

/* Becomes the program for `wanted` (NULL: the best that the processor has), with threads bound to
 * cores and waiting as those of talus-worker do. Returns if this is the program already, or if
 * there is no other; -1 if `wanted` cannot be had. */
int benchmark_isa_switch(const char *wanted, char **arguments);

#endif

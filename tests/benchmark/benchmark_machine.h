/* SPDX-License-Identifier: Apache-2.0 */
/* What the machine is called, and what is free of it. */
#ifndef BENCHMARK_MACHINE_H
#define BENCHMARK_MACHINE_H

#include <stddef.h>

/* Name of the processor ("unknown processor" if the system does not tell). */
void benchmark_processor(char *name, size_t size);
/* The same as a file name: lower case, digits and hyphens. */
void benchmark_processor_slug(char *slug, size_t size);
/* Bytes of memory that could be taken now; 0 if the system does not tell. */
double benchmark_free_memory(void);
/* Bytes that this process has allocated, touched or not. */
double benchmark_allocated_memory(void);

#endif

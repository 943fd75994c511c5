/* SPDX-License-Identifier: Apache-2.0 */
/* The command line. */
#ifndef BENCHMARK_OPTIONS_H
#define BENCHMARK_OPTIONS_H

#include "benchmark_measure.h"

struct benchmark_options {
    struct benchmark_setup setup; /* of --case; subject NULL without it */
    struct benchmark_effort effort;
    const char *isa; /* NULL: the best */
};

/* False after a message about what is wrong. */
bool benchmark_options_read(int argument_count, char **arguments,
                            struct benchmark_options *options);

#endif

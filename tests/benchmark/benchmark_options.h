/* SPDX-License-Identifier: Apache-2.0 */
/* The command line. */
#ifndef BENCHMARK_OPTIONS_H
#define BENCHMARK_OPTIONS_H

#include "benchmark_suite.h"

struct benchmark_options {
    bool whole; /* the suite, in this form: */
    enum benchmark_form form;
    const char *path; /* of the results; NULL: named after the processor, in `folder` */
    const char *folder;
    struct benchmark_setup setup; /* otherwise one measurement */
    struct benchmark_effort effort;
    bool single;     /* precision */
    const char *isa; /* NULL: the best */
};

/* False after a message about what is wrong. */
bool benchmark_options_read(int argument_count, char **arguments,
                            struct benchmark_options *options);

#endif

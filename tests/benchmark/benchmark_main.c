/* SPDX-License-Identifier: Apache-2.0 */
/* talus-benchmark: how fast the solver is on this machine, and against what the machine can do. */
#include "benchmark_isa.h"
#include "benchmark_options.h"
#include "benchmark_report.h"

#include <stdio.h>

int main(int argument_count, char **arguments)
{
    struct benchmark_options options;
    struct benchmark_result result;
    if (!benchmark_options_read(argument_count, arguments, &options))
        return 2;
    if (benchmark_isa_switch(options.isa, arguments) != 0) {
        (void)fprintf(stderr, "talus-benchmark: no program for the instruction set '%s'\n",
                      options.isa == NULL ? "of this machine" : options.isa);
        return 2;
    }
    if (!benchmark_measure(&options.setup, &options.effort, &result))
        return 1;
    benchmark_report_one(&options.setup, &result);
    return 0;
}

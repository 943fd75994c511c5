/* SPDX-License-Identifier: Apache-2.0 */
/* talus-benchmark: how fast the solver is on this machine, and against what the machine can do. */
#include "benchmark_csv.h"
#include "benchmark_isa.h"
#include "benchmark_machine.h"
#include "benchmark_options.h"
#include "benchmark_report.h"
#include "benchmark_table.h"

#include <limits.h>
#include <stdio.h>

static int measure_one(const struct benchmark_options *options)
{
    struct benchmark_suite suite;
    benchmark_suite_run_one(&suite, &options->setup, &options->effort);
    bool good = suite.complete;
    if (good)
        benchmark_report_one(&suite.rows[0]);
    if (good && options->path != NULL)
        good = benchmark_csv_write(&suite, options->path);
    benchmark_suite_release(&suite);
    return good ? 0 : 1;
}

static int measure_all(const struct benchmark_options *options)
{
    struct benchmark_suite suite;
    char slug[128], path[PATH_MAX];
    benchmark_processor_slug(slug, sizeof slug);
    (void)snprintf(path, sizeof path, "%s/%s%s.csv", options->folder, slug,
                   options->single ? "-single" : "");
    benchmark_suite_run(&suite, options->form);
    benchmark_table_print(&suite);
    const bool written = benchmark_csv_write(&suite, options->path != NULL ? options->path : path);
    const bool good = written && suite.complete;
    benchmark_suite_release(&suite);
    return good ? 0 : 1;
}

int main(int argument_count, char **arguments)
{
    struct benchmark_options options;
    if (!benchmark_options_read(argument_count, arguments, &options))
        return 2;
    if (benchmark_isa_switch(options.isa, options.single, arguments) != 0) {
        (void)fprintf(stderr, "talus-benchmark: no program for %s precision and %s\n",
                      options.single ? "single" : "double",
                      options.isa == NULL ? "this machine" : options.isa);
        return 2;
    }
    return options.whole ? measure_all(&options) : measure_one(&options);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_table.h"

#include "benchmark_findings.h"
#include "benchmark_isa.h"
#include "benchmark_machine.h"
#include "talus/version.h"

#include <math.h>
#include <stdio.h>

static void print_machine(const struct benchmark_suite *suite)
{
    static const char *const names[CEILING_COUNT] = {"double", "float", "triad", "in place"};
    static const char *const units[CEILING_COUNT] = {"GFLOP/s", "GFLOP/s", "GB/s", "GB/s"};
    char processor[256];
    benchmark_processor(processor, sizeof processor);
    (void)printf("%s, %s, %s precision, %s\n", processor, benchmark_isa(),
                 benchmark_is_single() ? "single" : "double", talus_build());
    (void)printf("  load average before %.1f%s\n", suite->load,
                 suite->complete ? "" : ", INCOMPLETE");
    for (int kind = 0; kind < CEILING_COUNT; kind++) {
        (void)printf("  %-9s %7.1f %s of a core", names[kind], suite->ceilings[kind][0],
                     units[kind]);
        if (suite->threads > 1)
            (void)printf(", %.1f of each of two", suite->ceilings[kind][1]);
        (void)printf("\n");
    }
}

/* A share in percent, or a hyphen. */
static void print_share(double share)
{
    if (isfinite(share))
        (void)printf(" %5.1f", 100.0 * share);
    else
        (void)printf("     -");
}

static void print_label(const struct benchmark_row *row)
{
    const struct benchmark_setup *setup = &row->setup;
    (void)printf("%-12s %-22s %-7s %-13s %-4s %d %8zu", benchmark_set_word(row->set),
                 setup->subject->name, benchmark_body_word(setup), benchmark_ordering_word(setup),
                 benchmark_control_word(setup), setup->threads, row->result.particles);
}

static void print_row(const struct benchmark_row *row)
{
    const struct benchmark_result *result = &row->result;
    print_label(row);
    (void)printf(" %7.2f %7.2f-%-7.2f %6.3f %9.3g %4.0f %5.0f %5.0f %5.3f %7.5f",
                 1e3 / result->nanoseconds, 1e3 / result->quartile_high, 1e3 / result->quartile_low,
                 result->relative, result->simulated, result->bytes_stored, result->bytes_grid,
                 result->bytes_all, result->lane_fill, result->crossings);
    print_share(benchmark_row_gigaflops(row) / result->peak);
    print_share(benchmark_row_gigabytes(row) / result->bandwidth);
    print_share(row->witness.plastic);
    if (isfinite(row->witness.strain))
        (void)printf(" %7.1e", row->witness.strain);
    (void)printf("\n");
}

static void print_stages(const struct benchmark_row *row)
{
    print_label(row);
    for (size_t stage = 0; stage < STAGE_COUNT; stage++)
        (void)printf(" %7.2f", row->result.stage_nanoseconds[stage]);
    (void)printf("\n");
}

void benchmark_table_print(const struct benchmark_suite *suite)
{
    print_machine(suite);
    (void)printf(
        "\nrate: million particle-steps/s per core, median and quartiles of repeats; rel: "
        "per core, over the first of the set;\nsim: simulated seconds per second; B: bytes "
        "per particle stored, with the grid, and allocated; %%FMA and %%mem: of the peak and of "
        "the\n"
        "in-place bandwidth of the same moment; %%pl: particles that yield in a step; "
        "strain: of a step\n\n");
    (void)printf("%-12s %-22s %-7s %-13s %-4s %1s %8s %7s %15s %6s %9s %4s %5s %5s %5s %7s %5s %5s "
                 "%5s %7s\n",
                 "set", "case", "body", "ordering", "lock", "T", "N", "rate", "quartiles", "rel",
                 "sim", "B", "grid", "all", "fill", "cross", "%FMA", "%mem", "%pl", "strain");
    for (size_t index = 0; index < suite->row_count; index++)
        print_row(&suite->rows[index]);
    (void)printf("\nns per particle-step and stage, summed over threads\n%-71s", "");
#define STAGE(ENUM, name) (void)printf(" %7.7s", #name);
    TALUS_STAGES(STAGE)
#undef STAGE
    (void)printf("\n");
    for (size_t index = 0; index < suite->row_count; index++)
        print_stages(&suite->rows[index]);
    (void)printf("\n");
    benchmark_findings_write(suite, "", stdout);
}

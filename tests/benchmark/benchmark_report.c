/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_report.h"

#include "benchmark_isa.h"

#include <math.h>
#include <stdio.h>

static const char *const stage_names[STAGE_COUNT] = {
#define STAGE(ENUM, name) #name,
    TALUS_STAGES(STAGE)
#undef STAGE
};

static void print_stages(const struct benchmark_result *result)
{
    double sum = 0;
    for (size_t stage = 0; stage < STAGE_COUNT; stage++)
        sum += result->stage_nanoseconds[stage];
    for (size_t stage = 0; stage < STAGE_COUNT; stage++) {
        if (result->stage_nanoseconds[stage] > 0)
            (void)printf("  %-14s %9.3f ns  %5.1f %%\n", stage_names[stage],
                         result->stage_nanoseconds[stage],
                         100.0 * result->stage_nanoseconds[stage] / sum);
    }
    (void)printf("  %-14s %9.3f ns; the clock itself adds %.1f %%, taken off above\n", "sum", sum,
                 100.0 * result->clock_share);
}

void benchmark_report_one(const struct benchmark_row *row)
{
    const struct benchmark_setup *setup = &row->setup;
    const struct benchmark_result *result = &row->result;
    (void)printf(
        "%s, %s body, %s, %s, %s, anti-locking %s %s, %zu particles (%zu per cell and axis), "
        "%d thread%s, domain %g, %s, %s\n",
        setup->subject->name, benchmark_body_word(setup), benchmark_shape_word(setup),
        benchmark_transfer_word(setup), benchmark_ordering_word(setup),
        benchmark_control_word(setup), benchmark_field_word(setup), result->particles,
        setup->per_axis, setup->threads, setup->threads == 1 ? "" : "s", setup->domain_factor,
        benchmark_isa(), benchmark_is_single() ? "single" : "double");
    (void)printf("rate %.3f million particle-steps/s per core (best %.3f, quartiles %.3f %.3f): "
                 "%.2f ns; on the wall %.3f (best %.3f)\n",
                 1e3 / result->nanoseconds, 1e3 / result->fastest, 1e3 / result->quartile_high,
                 1e3 / result->quartile_low, result->nanoseconds, 1e3 / result->wall_nanoseconds,
                 1e3 / result->wall_fastest);
    (void)printf("step %.4g s, %.4g simulated s per s; bytes per particle %.0f stored, %.0f with "
                 "the grid, %.0f allocated; lane fill %.3f; crossings %.5f; dissipation %.3g; mass "
                 "error %.1g\n",
                 result->time_step, result->simulated, result->bytes_stored, result->bytes_grid,
                 result->bytes_all, result->lane_fill, result->crossings, result->dissipation,
                 result->mass_error);
    (void)printf(
        "meanwhile %.1f GFLOP/s and %.1f GB/s in place of a core; values of particles move "
        "at %.1f GB/s (%.0f %%)",
        result->peak, result->bandwidth, benchmark_row_gigabytes(row),
        100.0 * benchmark_row_gigabytes(row) / result->bandwidth);
    if (isfinite(row->operations))
        (void)printf(", %.0f operations make %.1f GFLOP/s (%.0f %%)", row->operations,
                     benchmark_row_gigaflops(row),
                     100.0 * benchmark_row_gigaflops(row) / result->peak);
    (void)printf("\n");
    print_stages(result);
}

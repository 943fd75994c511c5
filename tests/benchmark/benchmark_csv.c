/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_csv.h"

#include "benchmark_findings.h"
#include "benchmark_isa.h"
#include "benchmark_machine.h"
#include "talus/version.h"

#include <limits.h>
#include <stdio.h>
#include <time.h>

static void write_header(const struct benchmark_suite *suite, FILE *file)
{
    static const char *const names[CEILING_COUNT] = {
        "peak, double [GFLOP/s]", "peak, float [GFLOP/s]", "triad [GB/s]", "in place [GB/s]"};
    char processor[256], date[32] = "";
    const time_t now = time(NULL);
    struct tm calendar;
    benchmark_processor(processor, sizeof processor);
    if (gmtime_r(&now, &calendar) != NULL)
        (void)strftime(date, sizeof date, "%Y-%m-%d", &calendar);
    (void)fprintf(file, "# talus-benchmark, %s form, %.0f s, %s\n",
                  benchmark_form_word(suite->form), suite->seconds, date);
    (void)fprintf(file, "# processor: %s\n# build: %s\n# instruction set: %s, %s precision\n",
                  processor, talus_build(), benchmark_isa(),
                  benchmark_is_single() ? "single" : "double");
    for (int kind = 0; kind < CEILING_COUNT; kind++) {
        (void)fprintf(file, "# %s of a core: %.1f with one thread", names[kind],
                      suite->ceilings[kind][0]);
        if (suite->threads > 1)
            (void)fprintf(file, ", %.1f with two", suite->ceilings[kind][1]);
        (void)fprintf(file, "\n");
    }
}

static void write_columns(FILE *file)
{
    (void)fputs(
        "set,case,body,shape,transfer,ordering,anti_locking,threads,particles,per_axis,domain_"
        "factor,"
        "courant,"
        "steps,repeats,rate,rate_best,rate_low,rate_high,rate_wall,rate_wall_best,relative,"
        "nanoseconds,time_step,simulated,bytes_stored,bytes_grid,bytes_all,lane_fill,crossings,"
        "strain,"
        "plastic,dissipation,mass_error,operations,gigaflops,peak,gigabytes,bandwidth,clock_share",
        file);
#define STAGE(ENUM, name) (void)fputs(",ns_" #name, file);
    TALUS_STAGES(STAGE)
#undef STAGE
    (void)fputs("\n", file);
}

static void write_row(const struct benchmark_row *row, FILE *file)
{
    const struct benchmark_setup *setup = &row->setup;
    const struct benchmark_result *result = &row->result;
    (void)fprintf(file, "%s,%s,%s,%s,%s,%s,%s,%d,%zu,%zu,%g,%g,%zu,%zu",
                  benchmark_set_word(row->set), setup->subject->name, benchmark_body_word(setup),
                  benchmark_shape_word(setup), benchmark_transfer_word(setup),
                  benchmark_ordering_word(setup), benchmark_control_word(setup), setup->threads,
                  result->particles, setup->per_axis, setup->domain_factor, setup->courant,
                  row->effort.steps, row->effort.repeats);
    (void)fprintf(file, ",%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.5g", 1e3 / result->nanoseconds,
                  1e3 / result->fastest, 1e3 / result->quartile_high, 1e3 / result->quartile_low,
                  1e3 / result->wall_nanoseconds, 1e3 / result->wall_fastest, result->relative,
                  result->nanoseconds);
    (void)fprintf(file, ",%.4g,%.4g,%.0f,%.1f,%.1f,%.4f,%.6f,%.3g,%.4f,%.4g,%.2g",
                  result->time_step, result->simulated, result->bytes_stored, result->bytes_grid,
                  result->bytes_all, result->lane_fill, result->crossings, row->witness.strain,
                  row->witness.plastic, result->dissipation, result->mass_error);
    (void)fprintf(file, ",%.1f,%.3f,%.2f,%.3f,%.2f,%.3f", row->operations,
                  benchmark_row_gigaflops(row), result->peak, benchmark_row_gigabytes(row),
                  result->bandwidth, result->clock_share);
    for (size_t stage = 0; stage < STAGE_COUNT; stage++)
        (void)fprintf(file, ",%.4g", result->stage_nanoseconds[stage]);
    (void)fputs("\n", file);
}

bool benchmark_csv_write(const struct benchmark_suite *suite, const char *path)
{
    char aside[PATH_MAX];
    (void)snprintf(aside, sizeof aside, "%s.part", path);
    FILE *file = fopen(aside, "w");
    if (file == NULL) {
        perror(aside);
        return false;
    }
    write_header(suite, file);
    benchmark_findings_write(suite, "# ", file);
    write_columns(file);
    for (size_t index = 0; index < suite->row_count; index++)
        write_row(&suite->rows[index], file);
    const bool written = ferror(file) == 0;
    if (fclose(file) != 0 || !written || rename(aside, path) != 0) {
        perror(path);
        return false;
    }
    return true;
}

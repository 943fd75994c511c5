/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_findings.h"

#include <math.h>
#include <stdarg.h>

struct writing {
    const struct benchmark_suite *suite;
    const char *prefix;
    FILE *file;
};

__attribute__((format(printf, 3, 4))) static void
write_line(const struct writing *writing, const struct benchmark_row *row, const char *format, ...)
{
    va_list arguments;
    (void)fprintf(writing->file, "%s%s %s", writing->prefix, benchmark_set_word(row->set),
                  row->setup.subject->name);
    va_start(arguments, format);
    (void)vfprintf(writing->file, format, arguments);
    va_end(arguments);
    (void)fputs("\n", writing->file);
}

/* The row of the same set that differs as asked, or NULL. */
static const struct benchmark_row *find_row(const struct benchmark_suite *suite,
                                            const struct benchmark_row *like, bool last,
                                            int threads)
{
    for (size_t index = like->first; index < suite->row_count; index++) {
        const struct benchmark_row *row = &suite->rows[index];
        if (row->first == like->first && row->setup.last == last && row->setup.threads == threads &&
            row->setup.particles == like->setup.particles)
            return row;
    }
    return NULL;
}

/* Threads times the rate of a core over that with one thread: best times on the wall, and medians
 * of processor time, which leave out what other programs took. */
static void write_speed_up(const struct writing *writing, const struct benchmark_row *one,
                           const struct benchmark_row *two)
{
    const double threads = two->setup.threads;
    write_line(writing, two,
               " %s, %zu particles: two threads %.2f times one on the wall (best repeats), %.2f by "
               "processor time",
               benchmark_ordering_word(&two->setup), two->result.particles,
               threads * one->result.wall_fastest / two->result.wall_fastest,
               threads * two->result.relative / one->result.relative);
}

static void write_orderings(const struct writing *writing, const struct benchmark_row *row)
{
    const struct benchmark_row *last = find_row(writing->suite, row, true, 1);
    if (last == NULL)
        return;
    if (!row->setup.last && row->setup.threads == 1)
        write_line(
            writing, row,
            ": modified_last %.1f, last %.1f million particle-steps/s (%.0f %%); simulated "
            "seconds per second %.3g and %.3g (%.2f times)%s",
            1e3 / row->result.nanoseconds, 1e3 / last->result.nanoseconds,
            100.0 * last->result.nanoseconds / row->result.nanoseconds, row->result.simulated,
            last->result.simulated, row->result.simulated / last->result.simulated,
            last->setup.courant > 0 ? ", last at a quarter of its step: unstable otherwise" : "");
    const struct benchmark_row *single = find_row(writing->suite, row, row->setup.last, 1);
    if (row->setup.threads > 1 && single != NULL)
        write_speed_up(writing, single, row);
}

static void write_relative(const struct writing *writing, const struct benchmark_row *row)
{
    const struct benchmark_row *first = &writing->suite->rows[row->first];
    const double cost = 100.0 * (1.0 / row->result.relative - 1.0);
    const char *ordering = benchmark_ordering_word(&row->setup);
    if (row == first)
        return;
    if (row->set == BENCHMARK_SIZE)
        write_line(writing, row, " %s: %zu particles cost %+.1f %% over %zu", ordering,
                   row->result.particles, cost, first->result.particles);
    if (row->set == BENCHMARK_DENSITY)
        write_line(writing, row, " %s: %zu per cell and axis cost %+.1f %% over %zu", ordering,
                   row->setup.per_axis, cost, first->setup.per_axis);
    if (row->set == BENCHMARK_ANTI_LOCKING)
        write_line(writing, row, " %s: %s anti-locking costs %+.1f %%", ordering,
                   benchmark_control_word(&row->setup), cost);
    if (row->set == BENCHMARK_DOMAIN)
        write_line(writing, row, ": a grid of %g times the body's cells costs %+.1f %%",
                   row->setup.domain_factor, cost);
}

/* [us] of a step */
static double step_time(const struct benchmark_row *row)
{
    return 1e-3 * row->result.wall_fastest * (double)row->result.particles / row->setup.threads;
}

/* A straight line through the steps of the least and the largest number of particles. */
static void fit_step(const struct benchmark_row *few, const struct benchmark_row *many,
                     double *fixed, double *slope)
{
    *slope = (step_time(many) - step_time(few)) /
             ((double)many->result.particles - (double)few->result.particles);
    *fixed = step_time(few) - *slope * (double)few->result.particles;
}

/* Break-even of two threads: between the two sizes around it, on a line. */
static double break_even(const struct benchmark_suite *suite, const struct benchmark_row *first)
{
    double before = NAN, particles_before = 0;
    for (const struct benchmark_row *row = first;
         row < suite->rows + suite->row_count && row->first == first->first; row++) {
        const struct benchmark_row *two = find_row(suite, row, row->setup.last, 2);
        if (row->setup.threads != 1 || two == NULL)
            continue;
        const double gain = step_time(row) - step_time(two);
        const double particles = (double)row->result.particles;
        if (gain >= 0)
            return isnan(before) ? particles
                                 : particles_before +
                                       (particles - particles_before) * before / (before - gain);
        before = gain;
        particles_before = particles;
    }
    return INFINITY;
}

static void write_small(const struct writing *writing, const struct benchmark_row *first)
{
    const struct benchmark_suite *suite = writing->suite;
    const struct benchmark_row *many = first;
    double fixed, slope;
    while (many + 1 < suite->rows + suite->row_count && many[1].first == first->first)
        many++;
    many = find_row(suite, many, many->setup.last, 1);
    if (first != &suite->rows[first->first] || many == NULL || many == first)
        return;
    fit_step(first, many, &fixed, &slope);
    write_line(writing, first,
               ": a step takes %.1f us with %zu particles, %.1f us with %zu: %.1f us and %.0f ns a "
               "particle; two threads pay from %.0f particles on (inf: from more than here)",
               step_time(first), first->result.particles, step_time(many), many->result.particles,
               fixed, 1e3 * slope, break_even(suite, first));
}

static void write_automatic_step(const struct writing *writing, const struct benchmark_row *row)
{
    const double sum = benchmark_row_stage_sum(row);
    if (row->setup.threads == 1 && !row->setup.last)
        write_line(writing, row,
                   ": choosing the step takes %.2f %% of the time, the energy check %.2f %%",
                   100.0 * row->result.stage_nanoseconds[STAGE_TIME_STEP] / sum,
                   100.0 * row->result.stage_nanoseconds[STAGE_ENERGY_CHECK] / sum);
}

void benchmark_findings_write(const struct benchmark_suite *suite, const char *prefix, FILE *file)
{
    const struct writing writing = {suite, prefix, file};
    for (size_t index = 0; index < suite->row_count; index++) {
        const struct benchmark_row *row = &suite->rows[index];
        if (row->set == BENCHMARK_ORDERING || row->set == BENCHMARK_DEVELOPED)
            write_orderings(&writing, row);
        else if (row->set == BENCHMARK_SMALL)
            write_small(&writing, row);
        else
            write_relative(&writing, row);
        if (row->set == BENCHMARK_ORDERING)
            write_automatic_step(&writing, row);
    }
}

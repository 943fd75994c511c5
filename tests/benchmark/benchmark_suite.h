/* SPDX-License-Identifier: Apache-2.0 */
/* All measurements in one go: their order, their effort, and the rows that they give. */
#ifndef BENCHMARK_SUITE_H
#define BENCHMARK_SUITE_H

#include "benchmark_measure.h"
#include "benchmark_witness.h"

#include <stdio.h>

enum benchmark_form {
    BENCHMARK_ONE,   /* one measurement */
    BENCHMARK_SMOKE, /* seconds: that everything runs, not how fast */
    BENCHMARK_SHORT, /* a minute */
    BENCHMARK_FULL,  /* an hour */
};

/* Measured side by side and compared with the first of them. */
enum benchmark_set {
    BENCHMARK_ORDERING,     /* both orderings, one thread and two */
    BENCHMARK_SIZE,         /* few particles to many */
    BENCHMARK_DENSITY,      /* particles per cell in two dimensions */
    BENCHMARK_ANTI_LOCKING, /* without and with, both orderings */
    BENCHMARK_DOMAIN,       /* an empty grid of any size around the body */
    BENCHMARK_SMALL,        /* few particles, one thread and two */
    BENCHMARK_DEVELOPED,    /* the developed flow */
    BENCHMARK_SINGLE,       /* what was asked for */
    BENCHMARK_SET_COUNT
};

struct benchmark_row {
    enum benchmark_set set;
    size_t first; /* index of the row that `relative` refers to */
    struct benchmark_setup setup;
    struct benchmark_effort effort;
    struct benchmark_result result;
    struct benchmark_witness witness; /* NAN where nobody looked */
    double operations;                /* floating-point, per slot and step; NAN: not counted */
};

struct benchmark_suite {
    enum benchmark_form form;
    struct ceiling ceiling;
    double ceilings[CEILING_COUNT][2]; /* of a core, with one thread and with two */
    int threads;                       /* at most: 2, or 1 on a single processor */
    struct benchmark_row *rows;        /* [row_count] owned */
    size_t row_count, row_capacity;
    double seconds;
    double load;   /* runnable programs on the machine before, its average of a minute */
    bool complete; /* everything could be measured */
};

const char *benchmark_set_word(enum benchmark_set set);
const char *benchmark_form_word(enum benchmark_form form);
/* What a core achieves in operations on particles, and in moving their values; NAN: not counted. */
double benchmark_row_gigaflops(const struct benchmark_row *row);
double benchmark_row_gigabytes(const struct benchmark_row *row);
/* Sum over the stages [ns]. */
double benchmark_row_stage_sum(const struct benchmark_row *row);
/* Measures, and tells on stderr how far it is; stops at what cannot be measured. */
void benchmark_suite_run(struct benchmark_suite *suite, enum benchmark_form form);
/* The same for one measurement, without looking for a step that is stable. */
void benchmark_suite_run_one(struct benchmark_suite *suite, const struct benchmark_setup *setup,
                             const struct benchmark_effort *effort);
void benchmark_suite_release(struct benchmark_suite *suite);

#endif

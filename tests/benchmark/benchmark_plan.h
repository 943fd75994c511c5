/* SPDX-License-Identifier: Apache-2.0 */
/* How much of everything a form of the benchmark measures. */
#ifndef BENCHMARK_PLAN_H
#define BENCHMARK_PLAN_H

#include "benchmark_suite.h"

enum { PLAN_SIZE_MAX = 3, PLAN_SMALL_MAX = 4 };

struct benchmark_plan {
    const char *word;
    bool every; /* every case in every set; otherwise the capped Drucker-Prager model in 3-D */
    size_t particles;
    struct benchmark_effort effort;
    size_t sizes[PLAN_SIZE_MAX]; /* 0: no more */
    struct benchmark_effort size_effort;
    size_t domain_particles;
    double domains[PLAN_SIZE_MAX];
    size_t small[PLAN_SMALL_MAX];
    struct benchmark_effort small_effort;
    size_t flow_particles;
    size_t witness_particles;
    int ceiling_tries;
};

/* By form. */
extern const struct benchmark_plan benchmark_plans[];

#endif

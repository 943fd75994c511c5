/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_measure.h"

#include "benchmark_bench.h"
#include "benchmark_clock.h"
#include "benchmark_isa.h"

#include <stdlib.h>

/* What the machine can do at this moment, with as many threads as the bench. */
static void probe(const struct ceiling *ceiling, struct bench *bench, size_t repeat)
{
    const int threads = bench->setup->threads;
    const enum ceiling_kind kind = benchmark_is_single() ? CEILING_FLOAT : CEILING_DOUBLE;
    bench->peak[repeat] = ceiling_measure(ceiling, kind, threads, 1);
    bench->bandwidth[repeat] = ceiling_measure(ceiling, CEILING_IN_PLACE, threads, 1);
}

static void run_repeats(const struct ceiling *ceiling, struct bench *benches, size_t count,
                        size_t repeats)
{
    for (size_t index = 0; index < count; index++)
        bench_warm(&benches[index]);
    for (size_t repeat = 0; repeat < repeats; repeat++) {
        for (size_t index = 0; index < count; index++) {
            if (benches[index].failed)
                continue;
            probe(ceiling, &benches[index], repeat);
            bench_time_plain(&benches[index], repeat);
            bench_time_stages(&benches[index], repeat);
        }
    }
}

/* Median over the repeats of the ratio of times. */
static double relative_rate(const struct bench *first, const struct bench *other, size_t repeats)
{
    double *ratios = calloc(repeats, sizeof *ratios);
    if (ratios == NULL)
        return 0;
    for (size_t repeat = 0; repeat < repeats; repeat++)
        ratios[repeat] = first->plain[repeat] / other->plain[repeat];
    benchmark_sort(ratios, repeats);
    const double ratio = benchmark_quantile(ratios, repeats, 0.5);
    free(ratios);
    return ratio;
}

bool benchmark_measure(const struct ceiling *ceiling, const struct benchmark_setup *setups,
                       size_t count, const struct benchmark_effort *effort,
                       struct benchmark_result *results)
{
    struct bench *benches = calloc(count, sizeof *benches);
    bool good = benches != NULL;
    for (size_t index = 0; good && index < count; index++)
        good = bench_create(&benches[index], &setups[index], effort);
    if (good)
        run_repeats(ceiling, benches, count, effort->repeats);
    for (size_t index = 0; good && index < count; index++) {
        bench_summarise(&benches[index], &results[index]);
        if (!results[index].failed && !results[0].failed)
            results[index].relative = relative_rate(&benches[0], &benches[index], effort->repeats);
    }
    for (size_t index = 0; benches != NULL && index < count; index++)
        bench_release(&benches[index]);
    free(benches);
    return good;
}

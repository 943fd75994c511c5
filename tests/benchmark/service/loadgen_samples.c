/* SPDX-License-Identifier: Apache-2.0 */
#include "loadgen_samples.h"

#include <stdlib.h>
#include <string.h>

void samples_add(struct samples *samples, double value)
{
    if (samples->count == samples->capacity) {
        size_t capacity = samples->capacity == 0 ? 4096 : 2 * samples->capacity;
        double *values = realloc(samples->values, capacity * sizeof *values);
        if (values == NULL) {
            samples->failed = true;
            return;
        }
        samples->values = values;
        samples->capacity = capacity;
    }
    samples->values[samples->count++] = value;
}

static int value_compare(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

void samples_write(struct samples *samples, FILE *stream)
{
    static const struct {
        const char *name;
        double share;
    } wanted[] = {{"p50", 0.5}, {"p90", 0.9}, {"p99", 0.99}, {"max", 1}};
    if (samples->count > 0)
        qsort(samples->values, samples->count, sizeof *samples->values, value_compare);
    for (size_t index = 0; index < sizeof wanted / sizeof wanted[0]; index++) {
        const char *comma = index == 0 ? "" : ",";
        if (samples->count == 0) {
            (void)fprintf(stream, "%s\"%s_ms\":null", comma, wanted[index].name);
            continue;
        }
        size_t place = (size_t)(wanted[index].share * (double)(samples->count - 1) + 0.5);
        (void)fprintf(stream, "%s\"%s_ms\":%.4f", comma, wanted[index].name,
                      1e3 * samples->values[place]);
    }
}

void samples_release(struct samples *samples)
{
    free(samples->values);
    memset(samples, 0, sizeof *samples);
}

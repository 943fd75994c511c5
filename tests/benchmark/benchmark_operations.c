/* SPDX-License-Identifier: Apache-2.0 */
#include "benchmark_operations.h"

#include "benchmark_isa.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name, *ordering, *control;
    double operations;
} counts[] = {
#define OPERATIONS(name, ordering, control, operations) {#name, #ordering, #control, operations},
#include "operation_counts.def"
#undef OPERATIONS
};

double benchmark_operations(const struct benchmark_setup *setup)
{
    if (benchmark_is_single() || setup->shape != NULL || setup->transfer != NULL)
        return NAN; /* counted in double precision, with the default shape and transfer only */
    for (size_t index = 0; index < sizeof counts / sizeof counts[0]; index++) {
        if (strcmp(counts[index].name, setup->subject->name) == 0 &&
            strcmp(counts[index].ordering, benchmark_ordering_word(setup)) == 0 &&
            strcmp(counts[index].control, benchmark_control_word(setup)) == 0)
            return counts[index].operations;
    }
    return NAN;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "state/time_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Number of points at or before `time`. */
static size_t points_until(const struct talus_time_table *table, double time)
{
    size_t low = 0, high = table->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (table->time[middle] <= time)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

double time_table_value(const struct talus_time_table *table, double constant, double time)
{
    if (table->count == 0)
        return constant;
    size_t next = points_until(table, time);
    if (next == 0)
        return table->value[0];
    if (next == table->count)
        return table->value[next - 1];
    double share = (time - table->time[next - 1]) / (table->time[next] - table->time[next - 1]);
    return (1.0 - share) * table->value[next - 1] + share * table->value[next];
}

void time_table_vector(const struct talus_time_table tables[3], const double constant[3],
                       double time, double value[3])
{
    for (size_t axis = 0; axis < 3; axis++)
        value[axis] = time_table_value(&tables[axis], constant[axis], time);
}

double time_table_largest(const struct talus_time_table *table, double constant)
{
    double largest = table->count == 0 ? fabs(constant) : 0.0;
    for (size_t point = 0; point < table->count; point++)
        largest = fmax(largest, fabs(table->value[point]));
    return largest;
}

bool time_table_varies(const struct talus_time_table *tables, size_t count)
{
    for (size_t index = 0; index < count; index++) {
        if (tables[index].count > 0)
            return true;
    }
    return false;
}

static double *duplicate(const double *source, size_t count)
{
    double *copy = malloc(count * sizeof *copy);
    if (copy != NULL)
        memcpy(copy, source, count * sizeof *copy);
    return copy;
}

int time_table_duplicate(struct talus_time_table *tables, size_t count)
{
    int failed = 0;
    for (size_t index = 0; index < count; index++) {
        struct talus_time_table *table = &tables[index];
        if (table->count == 0)
            continue;
        table->time = duplicate(table->time, table->count);
        table->value = duplicate(table->value, table->count);
        if (table->time == NULL || table->value == NULL) {
            time_table_release(table, 1);
            failed = -1;
        }
    }
    return failed;
}

void time_table_release(struct talus_time_table *tables, size_t count)
{
    for (size_t index = 0; index < count; index++) {
        free(tables[index].time);
        free(tables[index].value);
        memset(&tables[index], 0, sizeof tables[index]);
    }
}

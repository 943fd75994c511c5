/* SPDX-License-Identifier: Apache-2.0 */
/* Quantities of a scene that follow a table over time (struct talus_time_table): linear between
 * its points, constant outside. A table without points stands for "constant". */
#ifndef TALUS_TIME_TABLE_H
#define TALUS_TIME_TABLE_H

#include "talus/scene.h"

/* Value at a time [s]; `constant` if the table has no points. */
double time_table_value(const struct talus_time_table *table, double constant, double time);

/* Value of three components at once. */
void time_table_vector(const struct talus_time_table tables[3], const double constant[3],
                       double time, double value[3]);

/* Largest magnitude at any time. */
double time_table_largest(const struct talus_time_table *table, double constant);

/* True if any of `count` tables has points. */
bool time_table_varies(const struct talus_time_table *tables, size_t count);

/* Replaces the arrays of `count` tables by copies that the tables own (deep copy after copying the
 * struct). Without memory: -1; the tables are valid (empty where not copied) either way. */
int time_table_duplicate(struct talus_time_table *tables, size_t count);

/* Frees the arrays of `count` tables and empties them; accepts zeroed ones. */
void time_table_release(struct talus_time_table *tables, size_t count);

#endif

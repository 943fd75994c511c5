/* SPDX-License-Identifier: Apache-2.0 */
/* The forces on boundaries as a stream of events tells them: present values and peaks so far. */
#ifndef TALUS_REACTION_TABLE_H
#define TALUS_REACTION_TABLE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

struct reaction {
    char name[96];          /* "column" or "column.x_min" */
    bool present[3];        /* components that the run has (2D: no z) */
    double force[3];        /* [N] (2D: per metre) over the last history interval */
    double time;            /* [s] of it */
    double peak, peak_time; /* largest magnitude of an interval's force so far */
    /* Squares of the components of the rows that are being told, summed component by component. */
    double *rows;
    size_t row_count, row_capacity;
    double rows_start; /* [s] time of the first of them */
};

/* Zero it before use; release it. */
struct reaction_table {
    struct reaction *items; /* in the order in which they came */
    size_t count;
};

/* Takes the data of a `reaction` event, {"name","time":[],"value":[]}; what is no component of a
 * force is passed over. False when memory ran out. */
bool reaction_table_add(struct reaction_table *table, const json_t *data);
/* Forgets peaks later than `time` (a resumed run goes back). */
void reaction_table_rewind(struct reaction_table *table, double time);
void reaction_table_release(struct reaction_table *table);

/* A reaction in words: "column: (75.1, 0.0, -0.2) kN, peak 171 kN at 1.310 s". `unit` is that of a
 * force in this job, "N" or "N/m" (NULL: N). */
void reaction_format(const struct reaction *reaction, const char *unit, char *text, size_t size);

/* Splits "reaction.NAME[.FACE].force.x" into name and component 0..2; false for other series. */
bool reaction_series_parse(const char *series, char *name, size_t size, int *component);

/* A force with the prefix that fits: 75300 -> "75.3 kN". */
void force_format(double force, const char *unit, char *text, size_t size);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
#include "reaction_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool reaction_series_parse(const char *series, char *name, size_t size, int *component)
{
    static const char start[] = "reaction.";
    const size_t length = strlen(series);
    if (strncmp(series, start, sizeof start - 1) != 0 || length < sizeof start + 8)
        return false;
    const char *end = series + length - strlen(".force.x");
    if (strncmp(end, ".force.", 7) != 0 || end[7] < 'x' || end[7] > 'z')
        return false;
    const size_t name_length = (size_t)(end - series) - (sizeof start - 1);
    if (name_length == 0 || name_length >= size)
        return false;
    memcpy(name, series + sizeof start - 1, name_length);
    name[name_length] = '\0';
    *component = end[7] - 'x';
    return true;
}

static struct reaction *find_or_add(struct reaction_table *table, const char *name)
{
    for (size_t index = 0; index < table->count; index++) {
        if (strcmp(table->items[index].name, name) == 0)
            return &table->items[index];
    }
    struct reaction *items = realloc(table->items, (table->count + 1) * sizeof *items);
    if (items == NULL)
        return NULL;
    table->items = items;
    struct reaction *reaction = &items[table->count++];
    memset(reaction, 0, sizeof *reaction);
    (void)snprintf(reaction->name, sizeof reaction->name, "%s", name);
    return reaction;
}

/* Makes room for the rows of an event; starts anew unless they are those of the component before.
 */
static bool prepare_rows(struct reaction *reaction, size_t count, double start)
{
    if (count == reaction->row_count && start == reaction->rows_start && count > 0)
        return true;
    if (count > reaction->row_capacity) {
        double *rows = realloc(reaction->rows, count * sizeof *rows);
        if (rows == NULL)
            return false;
        reaction->rows = rows;
        reaction->row_capacity = count;
    }
    for (size_t row = 0; row < count; row++)
        reaction->rows[row] = 0.0;
    reaction->row_count = count;
    reaction->rows_start = start;
    return true;
}

bool reaction_table_add(struct reaction_table *table, const json_t *data)
{
    char name[96];
    int component;
    const char *series = json_string_value(json_object_get(data, "name"));
    const json_t *times = json_object_get(data, "time"), *values = json_object_get(data, "value");
    const size_t count = json_array_size(times);
    if (series == NULL || !reaction_series_parse(series, name, sizeof name, &component) ||
        count == 0 || json_array_size(values) != count)
        return true;
    struct reaction *reaction = find_or_add(table, name);
    if (reaction == NULL ||
        !prepare_rows(reaction, count, json_number_value(json_array_get(times, 0))))
        return false;
    for (size_t row = 0; row < count; row++) {
        const double time = json_number_value(json_array_get(times, row));
        const double value = json_number_value(json_array_get(values, row));
        reaction->rows[row] += value * value;
        /* Components come one after the other; with the last one the sum is complete. */
        if (sqrt(reaction->rows[row]) > reaction->peak) {
            reaction->peak = sqrt(reaction->rows[row]);
            reaction->peak_time = time;
        }
        reaction->force[component] = value;
        reaction->time = time;
    }
    reaction->present[component] = true;
    return true;
}

void reaction_table_rewind(struct reaction_table *table, double time)
{
    for (size_t index = 0; index < table->count; index++) {
        struct reaction *reaction = &table->items[index];
        reaction->row_count = 0;
        if (reaction->peak_time > time)
            reaction->peak = reaction->peak_time = 0.0;
    }
}

void reaction_table_release(struct reaction_table *table)
{
    for (size_t index = 0; index < table->count; index++)
        free(table->items[index].rows);
    free(table->items);
    memset(table, 0, sizeof *table);
}

struct prefix {
    double factor;
    const char *name;
};

static struct prefix find_prefix(double size)
{
    static const struct prefix prefixes[] = {{1e-9, "G"}, {1e-6, "M"}, {1e-3, "k"}};
    for (size_t index = 0; index < sizeof prefixes / sizeof prefixes[0]; index++) {
        if (fabs(size) * prefixes[index].factor >= 1.0)
            return prefixes[index];
    }
    return (struct prefix){1.0, ""};
}

void force_format(double force, const char *unit, char *text, size_t size)
{
    const struct prefix prefix = find_prefix(force);
    (void)snprintf(text, size, "%.4g %s%s", force * prefix.factor, prefix.name,
                   unit == NULL ? "N" : unit);
}

void reaction_format(const struct reaction *reaction, const char *unit, char *text, size_t size)
{
    char peak[48];
    const struct prefix prefix = find_prefix(reaction->peak);
    size_t used = (size_t)snprintf(text, size, "%s: ", reaction->name);
    char separator = '(';
    for (int component = 0; component < 3 && used < size; component++) {
        if (!reaction->present[component])
            continue;
        used += (size_t)snprintf(text + used, size - used, "%c%s%.1f", separator,
                                 separator == '(' ? "" : " ",
                                 reaction->force[component] * prefix.factor);
        separator = ',';
    }
    force_format(reaction->peak, unit, peak, sizeof peak);
    if (used < size)
        (void)snprintf(text + used, size - used, ") %s%s, peak %s at %.3f s", prefix.name,
                       unit == NULL ? "N" : unit, peak, reaction->peak_time);
}

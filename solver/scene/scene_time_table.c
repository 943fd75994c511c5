/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_time_table.h"

#include "state/time_table.h"

#include <stdlib.h>
#include <string.h>

enum { POINT_MAX = 100000 };

static const struct scene_field time_field = {.key = "t", .unit = "s"};

static bool read_point(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *field, const json_t *given,
                       struct talus_time_table *table)
{
    struct scene_path time_path = {.parent = path, .index = 0};
    struct scene_path value_path = {.parent = path, .index = 1};
    double *time = &table->time[table->count], *value = &table->value[table->count];
    if (!json_is_array(given) || json_array_size(given) != 2) {
        scene_mistake(reader, path, "type", given, json_string("[t, value]"),
                      "a point of a time table is [t, value]");
        return false;
    }
    bool valid = scene_number_read(reader, &time_path, &time_field, json_array_get(given, 0), time);
    if (!scene_number_read(reader, &value_path, field, json_array_get(given, 1), value) || !valid)
        return false;
    if (table->count > 0 && *time <= time[-1]) {
        scene_mistake(reader, &time_path, "order", json_array_get(given, 0), NULL,
                      "the times of a table grow: %g s is not after %g s", *time, time[-1]);
        return false;
    }
    table->count++;
    return true;
}

/* Room for the points, which are not counted yet; false with a mistake. */
static bool open_table(struct scene_reader *reader, const struct scene_path *path, size_t count,
                       struct talus_time_table *table)
{
    if (count == 0 || count > POINT_MAX) {
        scene_mistake(reader, path, "length", NULL, json_integer(POINT_MAX),
                      "a time table has 1 to %d points, not %zu", POINT_MAX, count);
        return false;
    }
    table->time = malloc(count * sizeof *table->time);
    table->value = malloc(count * sizeof *table->value);
    if (table->time != NULL && table->value != NULL)
        return true;
    reader->out_of_memory = true;
    return false;
}

static json_t *effective_table(struct scene_reader *reader, const struct talus_time_table *table)
{
    json_t *points = json_array();
    for (size_t index = 0; index < table->count; index++) {
        json_t *point = json_pack("[f, f]", table->time[index], table->value[index]);
        if (json_array_append_new(points, point) != 0)
            reader->out_of_memory = true;
    }
    return points;
}

static bool read_table(struct scene_reader *reader, const struct scene_path *path,
                       const struct scene_field *field, const json_t *given,
                       struct talus_time_table *table)
{
    const bool open = open_table(reader, path, json_array_size(given), table);
    bool valid = open;
    for (size_t index = 0; open && index < json_array_size(given); index++) {
        struct scene_path here = {.parent = path, .index = index};
        valid = read_point(reader, &here, field, json_array_get(given, index), table) && valid;
    }
    if (!valid)
        time_table_release(table, 1);
    return valid;
}

bool scene_timed_number_read(struct scene_reader *reader, const struct scene_path *path,
                             const struct scene_field *field, const json_t *given, double *value,
                             struct talus_time_table *table, json_t **effective)
{
    memset(table, 0, sizeof *table);
    if (!json_is_array(given)) {
        if (!scene_number_read(reader, path, field, given, value))
            return false;
        *effective = json_real(*value);
        return true;
    }
    if (!read_table(reader, path, field, given, table))
        return false;
    *value = time_table_value(table, 0.0, 0.0);
    *effective = effective_table(reader, table);
    return true;
}

bool scene_timed_vector_read(struct scene_reader *reader, const struct scene_path *path,
                             const struct scene_field *field, const json_t *given, double value[3],
                             struct talus_time_table tables[3], json_t **effective)
{
    json_t *parts = json_array();
    bool valid = scene_vector_length_check(reader, path, field, given);
    memset(tables, 0, 3 * sizeof *tables);
    const size_t count = valid ? json_array_size(given) : 0;
    for (size_t k = 0; k < count; k++) {
        struct scene_path here = {.parent = path, .index = k};
        json_t *part = NULL;
        if (!scene_timed_number_read(reader, &here, field, json_array_get(given, k), &value[k],
                                     &tables[k], &part))
            valid = false;
        else if (json_array_append_new(parts, part) != 0)
            reader->out_of_memory = true;
    }
    if (valid) {
        *effective = parts;
    } else {
        json_decref(parts);
        time_table_release(tables, 3);
    }
    return valid;
}

json_t *scene_timed_number_schema(const struct scene_field *field)
{
    struct scene_field number = *field;
    number.kind = SCENE_NUMBER;
    json_t *point =
        json_pack("{s:s, s:i, s:i, s:[o, o]}", "type", "array", "minItems", 2, "maxItems", 2,
                  "prefixItems", scene_number_schema(&time_field), scene_number_schema(field));
    return json_pack("{s:[o, {s:s, s:i, s:i, s:o}], s:s}", "oneOf", scene_field_schema(&number),
                     "type", "array", "minItems", 1, "maxItems", (int)POINT_MAX, "items", point,
                     "description", "a number, or a table [[t, value], ...] over time");
}

json_t *scene_timed_vector_schema(const struct scene_field *field)
{
    json_t *schema = scene_axes_schema(scene_timed_number_schema(field), 0);
    (void)json_object_set_new(schema, "description",
                              json_string(field->meaning != NULL ? field->meaning : ""));
    return schema;
}

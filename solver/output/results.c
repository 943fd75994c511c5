/* SPDX-License-Identifier: Apache-2.0 */
#include "output/hdf5_file.h"
#include "output/history.h"

#include <stdlib.h>
#include <string.h>

/* Where a series goes, by the first word of its name; the last entry takes the rest. */
struct results_group {
    const char *prefix, *group;
};
static const struct results_group results_groups[] = {
    {"probe.", "probes"}, {"reaction.", "reactions"}, {"energy.", "energies"}, {"", "others"}};
enum { RESULTS_GROUP_COUNT = sizeof results_groups / sizeof results_groups[0] };

static size_t find_group(const char *name)
{
    size_t index = 0;
    while (strncmp(name, results_groups[index].prefix, strlen(results_groups[index].prefix)) != 0)
        index++;
    return index;
}

static enum talus_status write_series(hid_t group, const struct history_table *table, size_t column,
                                      const char *name, double *values, struct talus_error *error)
{
    for (uint64_t row = 0; row < table->row_count; row++)
        values[row] = history_value(table, row, column);
    struct hdf5_array array = {.name = name,
                               .unit = table->columns[column].unit,
                               .memory_type = H5T_NATIVE_DOUBLE,
                               .file_type = H5T_IEEE_F64LE,
                               .count = (size_t)table->row_count,
                               .components = 1,
                               .data = values,
                               .packing = HDF5_PACKED};
    return hdf5_write_marked_array(group, &array, "series", table->columns[column].name, error);
}

static enum talus_status write_group(hid_t file, const struct history_table *table,
                                     size_t group_index, double *values, struct talus_error *error)
{
    hid_t group = H5I_INVALID_HID;
    const struct results_group *entry = &results_groups[group_index];
    enum talus_status status = hdf5_create_group(file, entry->group, &group, error);
    for (size_t column = 1; status == TALUS_OK && column < table->column_count; column++) {
        const char *name = table->columns[column].name;
        if (find_group(name) == group_index)
            status =
                write_series(group, table, column, name + strlen(entry->prefix), values, error);
    }
    if (group >= 0)
        (void)H5Gclose(group);
    return status;
}

static enum talus_status write_contents(hid_t file, const struct history_table *table,
                                        const char *scene, const char *receipt,
                                        struct talus_error *error)
{
    double *values = calloc((size_t)table->row_count + 1, sizeof *values);
    if (values == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for results.h5");
    enum talus_status status = write_series(file, table, 0, "time", values, error);
    for (size_t index = 0; status == TALUS_OK && index < RESULTS_GROUP_COUNT; index++)
        status = write_group(file, table, index, values, error);
    if (status == TALUS_OK && scene != NULL)
        status = hdf5_write_text(file, "scene", scene, error);
    if (status == TALUS_OK && receipt != NULL)
        status = hdf5_write_text(file, "receipt", receipt, error);
    free(values);
    return status;
}

enum talus_status results_write(const struct history_table *table, const char *path,
                                const char *scene, const char *receipt, struct talus_error *error)
{
    struct hdf5_file file;
    enum talus_status status = hdf5_create(&file, path, error);
    if (status != TALUS_OK)
        return status;
    status = write_contents(file.file, table, scene, receipt, error);
    if (status == TALUS_OK)
        status = hdf5_publish(&file, error);
    else
        hdf5_abandon(&file);
    return status;
}

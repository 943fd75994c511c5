/* SPDX-License-Identifier: Apache-2.0 */
#include "output/frame_read.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum talus_status frame_read_failed(struct talus_error *error, const char *name)
{
    return talus_error_set(error, TALUS_IO, "frame", "/frame",
                           "the frame's dataset %s cannot be read", name);
}

static void read_unit(hid_t dataset, char *unit, size_t size)
{
    unit[0] = '\0';
    if (H5Aexists(dataset, "units") <= 0)
        return;
    hid_t attribute = H5Aopen(dataset, "units", H5P_DEFAULT);
    hid_t type = attribute >= 0 ? H5Aget_type(attribute) : H5I_INVALID_HID;
    if (type >= 0 && H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 &&
        H5Tget_size(type) < size && H5Aread(attribute, type, unit) >= 0)
        unit[H5Tget_size(type)] = '\0';
    if (type >= 0)
        (void)H5Tclose(type);
    if (attribute >= 0)
        (void)H5Aclose(attribute);
}

static enum talus_status read_dataset(hid_t dataset, const char *name, struct frame_values *out,
                                      struct talus_error *error)
{
    hsize_t size[2] = {0, 1};
    hid_t space = H5Dget_space(dataset);
    int rank = space >= 0 ? H5Sget_simple_extent_ndims(space) : -1;
    bool shaped = (rank == 1 || rank == 2) && H5Sget_simple_extent_dims(space, size, NULL) >= 0;
    if (space >= 0)
        (void)H5Sclose(space);
    if (!shaped)
        return frame_read_failed(error, name);
    out->count = (size_t)size[0];
    out->components = (size_t)size[1];
    if (out->components == 0 || out->count > SIZE_MAX / out->components / sizeof(double))
        return frame_read_failed(error, name);
    out->values = malloc(out->count * out->components * sizeof(double) + 1);
    if (out->values == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a frame");
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out->values) < 0)
        return frame_read_failed(error, name);
    read_unit(dataset, out->unit, sizeof out->unit);
    return TALUS_OK;
}

enum talus_status frame_read_array(hid_t group, const char *name, struct frame_values *out,
                                   struct talus_error *error)
{
    *out = (struct frame_values){0};
    if (H5Lexists(group, name, H5P_DEFAULT) <= 0)
        return TALUS_OK;
    hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
    if (dataset < 0)
        return frame_read_failed(error, name);
    enum talus_status status = read_dataset(dataset, name, out, error);
    (void)H5Dclose(dataset);
    if (status != TALUS_OK) {
        free(out->values);
        out->values = NULL;
    }
    return status;
}

enum talus_status frame_read_open(const char *path, hid_t *file, struct talus_error *error)
{
    if (access(path, R_OK) != 0)
        return talus_error_set(error, errno == ENOENT ? TALUS_INVALID : TALUS_IO, "not_found",
                               "/frame", "there is no frame %s: %s", path, strerror(errno));
    return hdf5_open(file, path, error);
}

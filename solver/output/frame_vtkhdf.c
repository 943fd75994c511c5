/* SPDX-License-Identifier: Apache-2.0 */
#include "output/frame.h"
#include "output/hdf5_file.h"

#include <stdlib.h>
#include <string.h>

enum { VTK_VERTEX = 1 };

static enum talus_status write_one(hid_t group, const char *name, const char *unit, int64_t value,
                                   struct talus_error *error)
{
    struct hdf5_array array = {.name = name,
                               .unit = unit,
                               .memory_type = H5T_NATIVE_INT64,
                               .file_type = H5T_STD_I64LE,
                               .count = 1,
                               .components = 1,
                               .data = &value,
                               .packing = HDF5_PLAIN};
    return hdf5_write_array(group, &array, error);
}

static enum talus_status write_version(hid_t group, struct talus_error *error)
{
    static const int64_t version[2] = {1, 0};
    hsize_t size = 2;
    hid_t attribute = H5I_INVALID_HID;
    enum talus_status status = TALUS_OK;
    hid_t space = H5Screate_simple(1, &size, NULL);
    if (space >= 0)
        attribute = H5Acreate2(group, "Version", H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0 || H5Awrite(attribute, H5T_NATIVE_INT64, version) < 0)
        status = hdf5_error(error, "write attribute", "Version");
    if (attribute >= 0)
        (void)H5Aclose(attribute);
    if (space >= 0)
        (void)H5Sclose(space);
    return status;
}

static enum talus_status write_points(hid_t group, const struct frame *frame, hid_t real_type,
                                      struct talus_error *error)
{
    struct hdf5_array points = {.name = "Points",
                                .unit = "m",
                                .memory_type = H5T_NATIVE_DOUBLE,
                                .file_type = real_type,
                                .count = frame->point_count,
                                .components = 3,
                                .data = frame->positions,
                                .packing = HDF5_PACKED};
    int64_t count = (int64_t)frame->point_count;
    enum talus_status status = write_one(group, "NumberOfPoints", "1", count, error);
    if (status == TALUS_OK)
        status = write_one(group, "NumberOfCells", "1", count, error);
    if (status == TALUS_OK)
        status = write_one(group, "NumberOfConnectivityIds", "1", count, error);
    if (status == TALUS_OK)
        status = hdf5_write_array(group, &points, error);
    return status;
}

/* Cell i is the vertex of point i: Connectivity 0..n-1, Offsets 0..n, Types all VTK_VERTEX. */
static enum talus_status write_cells(hid_t group, size_t count, struct talus_error *error)
{
    int64_t *numbers = calloc(count + 1, sizeof *numbers);
    unsigned char *types = malloc(count + 1);
    enum talus_status status = TALUS_OK;
    if (numbers == NULL || types == NULL) {
        free(numbers);
        free(types);
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a frame");
    }
    for (size_t index = 0; index <= count; index++)
        numbers[index] = (int64_t)index;
    memset(types, VTK_VERTEX, count + 1);
    struct hdf5_array array = {.name = "Connectivity",
                               .unit = "1",
                               .memory_type = H5T_NATIVE_INT64,
                               .file_type = H5T_STD_I64LE,
                               .count = count,
                               .components = 1,
                               .data = numbers,
                               .packing = HDF5_PACKED};
    status = hdf5_write_array(group, &array, error);
    array.name = "Offsets";
    array.count = count + 1;
    if (status == TALUS_OK)
        status = hdf5_write_array(group, &array, error);
    array.name = "Types";
    array.count = count;
    array.memory_type = H5T_NATIVE_UCHAR;
    array.file_type = H5T_STD_U8LE;
    array.data = types;
    if (status == TALUS_OK)
        status = hdf5_write_array(group, &array, error);
    free(numbers);
    free(types);
    return status;
}

static enum talus_status write_point_data(hid_t parent, const struct frame *frame, hid_t real_type,
                                          struct talus_error *error)
{
    hid_t group = H5I_INVALID_HID;
    enum talus_status status = hdf5_create_group(parent, "PointData", &group, error);
    for (size_t index = 0; status == TALUS_OK && index < frame->array_count; index++) {
        const struct frame_array *source = &frame->arrays[index];
        struct hdf5_array array = {.name = source->name,
                                   .unit = source->unit,
                                   .memory_type = H5T_NATIVE_DOUBLE,
                                   .file_type =
                                       source->number == FRAME_INTEGER ? H5T_STD_I64LE : real_type,
                                   .count = frame->point_count,
                                   .components = source->components,
                                   .data = source->values,
                                   .packing = HDF5_PACKED};
        status = hdf5_write_array(group, &array, error);
    }
    if (group >= 0)
        (void)H5Gclose(group);
    return status;
}

static enum talus_status write_field_data(hid_t parent, const struct frame *frame,
                                          struct talus_error *error)
{
    hid_t group = H5I_INVALID_HID;
    enum talus_status status = hdf5_create_group(parent, "FieldData", &group, error);
    struct hdf5_array time = {.name = "Time",
                              .unit = "s",
                              .memory_type = H5T_NATIVE_DOUBLE,
                              .file_type = H5T_IEEE_F64LE,
                              .count = 1,
                              .components = 1,
                              .data = &frame->time,
                              .packing = HDF5_PLAIN};
    if (status == TALUS_OK)
        status = hdf5_write_array(group, &time, error);
    if (status == TALUS_OK)
        status = write_one(group, "Step", "1", (int64_t)frame->step, error);
    if (group >= 0)
        (void)H5Gclose(group);
    return status;
}

enum talus_status frame_write_vtkhdf(const struct frame *frame, const char *path,
                                     bool double_precision, struct talus_error *error)
{
    struct hdf5_file file;
    hid_t group = H5I_INVALID_HID;
    enum talus_status status = hdf5_create(&file, path, error);
    if (status != TALUS_OK)
        return status;
    hid_t real_type = double_precision ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
    status = hdf5_create_group(file.file, "VTKHDF", &group, error);
    if (status == TALUS_OK)
        status = write_version(group, error);
    if (status == TALUS_OK)
        status = hdf5_write_attribute(group, "Type", "UnstructuredGrid", error);
    if (status == TALUS_OK)
        status = write_points(group, frame, real_type, error);
    if (status == TALUS_OK)
        status = write_cells(group, frame->point_count, error);
    if (status == TALUS_OK)
        status = write_point_data(group, frame, real_type, error);
    if (status == TALUS_OK)
        status = write_field_data(group, frame, error);
    if (group >= 0)
        (void)H5Gclose(group);
    if (status == TALUS_OK)
        status = hdf5_publish(&file, error);
    else
        hdf5_abandon(&file);
    return status;
}

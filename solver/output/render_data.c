/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_data.h"

#include "output/hdf5_file.h"
#include "output/render_field.h"

#include <errno.h>
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* An array of a frame as it was read. */
struct frame_values {
    size_t count, components;
    double *values; /* [count * components] */
    char unit[32];
};

static enum talus_status read_failed(struct talus_error *error, const char *name)
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
        return read_failed(error, name);
    out->count = (size_t)size[0];
    out->components = (size_t)size[1];
    if (out->components == 0 || out->count > SIZE_MAX / out->components / sizeof(double))
        return read_failed(error, name);
    out->values = malloc(out->count * out->components * sizeof(double) + 1);
    if (out->values == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a picture");
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out->values) < 0)
        return read_failed(error, name);
    read_unit(dataset, out->unit, sizeof out->unit);
    return TALUS_OK;
}

/* Reads group/name; values stay NULL if there is no such dataset. */
static enum talus_status read_array(hid_t group, const char *name, struct frame_values *out,
                                    struct talus_error *error)
{
    *out = (struct frame_values){0};
    if (H5Lexists(group, name, H5P_DEFAULT) <= 0)
        return TALUS_OK;
    hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
    if (dataset < 0)
        return read_failed(error, name);
    enum talus_status status = read_dataset(dataset, name, out, error);
    (void)H5Dclose(dataset);
    if (status != TALUS_OK) {
        free(out->values);
        out->values = NULL;
    }
    return status;
}

static enum talus_status read_positions(hid_t file, struct render_data *data,
                                        struct talus_error *error)
{
    struct frame_values points;
    if (H5Lexists(file, "VTKHDF", H5P_DEFAULT) <= 0)
        return read_failed(error, "VTKHDF");
    enum talus_status status = read_array(file, "VTKHDF/Points", &points, error);
    if (status != TALUS_OK)
        return status;
    data->positions = points.values;
    data->count = points.count;
    return points.values == NULL || points.components != 3 ? read_failed(error, "Points")
                                                           : TALUS_OK;
}

static enum talus_status read_time(hid_t file, struct render_data *data, struct talus_error *error)
{
    struct frame_values time;
    if (H5Lexists(file, "VTKHDF/FieldData", H5P_DEFAULT) <= 0)
        return read_failed(error, "FieldData");
    enum talus_status status = read_array(file, "VTKHDF/FieldData/Time", &time, error);
    if (status != TALUS_OK)
        return status;
    if (time.values == NULL || time.count == 0)
        status = read_failed(error, "Time");
    else
        data->time = time.values[0];
    free(time.values);
    return status;
}

struct name_list {
    char text[512]; /* comma-separated */
    char first[64];
};

static herr_t collect_name(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
    (void)group;
    (void)info;
    struct name_list *list = context;
    if (list->first[0] == '\0')
        (void)snprintf(list->first, sizeof list->first, "%s", name);
    const size_t used = strlen(list->text);
    (void)snprintf(list->text + used, sizeof list->text - used, "%s%s", used > 0 ? ", " : "", name);
    return 0;
}

/* Splits "stress.xx" and chooses a field if none is asked for; false if the frame has no field. */
static bool choose_field(hid_t group, const char *field, struct name_list *list, char *name,
                         size_t size, const char **suffix)
{
    (void)H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, collect_name, list);
    if (field == NULL)
        field = H5Lexists(group, "velocity", H5P_DEFAULT) > 0 ? "velocity" : list->first;
    const char *dot = strchr(field, '.');
    *suffix = dot == NULL ? "" : dot + 1;
    (void)snprintf(name, size, "%.*s", dot == NULL ? (int)strlen(field) : (int)(dot - field),
                   field);
    return name[0] != '\0';
}

static enum talus_status read_values(hid_t group, const char *field, struct render_data *data,
                                     struct talus_error *error)
{
    struct name_list list = {0};
    struct frame_values array;
    char name[64];
    const char *suffix;
    if (!choose_field(group, field, &list, name, sizeof name, &suffix))
        return TALUS_OK;
    enum talus_status status = read_array(group, name, &array, error);
    if (status != TALUS_OK)
        return status;
    if (array.values == NULL)
        return talus_error_set(error, TALUS_INVALID, "unknown_value", "/field",
                               "the frame has no field '%s'; it has: %s", name, list.text);
    if (array.count != data->count)
        status = read_failed(error, name);
    else
        status = render_field_reduce(array.values, array.count, array.components, suffix, error);
    if (status != TALUS_OK) {
        free(array.values);
        return status;
    }
    data->values = array.values;
    render_field_label(name, array.components, suffix, data->label, sizeof data->label);
    (void)snprintf(data->unit, sizeof data->unit, "%s", array.unit);
    return TALUS_OK;
}

/* An array that a picture can use but need not have: dropped if it has another shape. */
static enum talus_status read_optional(hid_t group, const char *name, size_t count,
                                       size_t components, double **values,
                                       struct talus_error *error)
{
    struct frame_values array;
    enum talus_status status = read_array(group, name, &array, error);
    if (array.values != NULL && (array.count != count || array.components != components)) {
        free(array.values);
        array.values = NULL;
    }
    *values = array.values;
    return status;
}

static enum talus_status read_point_data(hid_t file, const char *field, struct render_data *data,
                                         struct talus_error *error)
{
    if (H5Lexists(file, "VTKHDF/PointData", H5P_DEFAULT) <= 0)
        return read_failed(error, "PointData");
    hid_t group = H5Gopen2(file, "VTKHDF/PointData", H5P_DEFAULT);
    if (group < 0)
        return read_failed(error, "PointData");
    enum talus_status status = read_values(group, field, data, error);
    if (status == TALUS_OK)
        status = read_optional(group, "volume", data->count, 1, &data->volumes, error);
    if (status == TALUS_OK)
        status =
            read_optional(group, "deformation_gradient", data->count, 9, &data->gradients, error);
    (void)H5Gclose(group);
    return status;
}

static enum talus_status open_frame(const char *path, hid_t *file, struct talus_error *error)
{
    if (access(path, R_OK) != 0)
        return talus_error_set(error, errno == ENOENT ? TALUS_INVALID : TALUS_IO, "not_found",
                               "/frame", "there is no frame %s: %s", path, strerror(errno));
    return hdf5_open(file, path, error);
}

enum talus_status render_data_read_positions(struct render_data *data, const char *path,
                                             struct talus_error *error)
{
    hid_t file = H5I_INVALID_HID;
    *data = (struct render_data){0};
    enum talus_status status = open_frame(path, &file, error);
    if (status == TALUS_OK)
        status = read_positions(file, data, error);
    if (file >= 0)
        (void)H5Fclose(file);
    return status;
}

enum talus_status render_data_read(struct render_data *data, const char *path, const char *field,
                                   struct talus_error *error)
{
    hid_t file = H5I_INVALID_HID;
    *data = (struct render_data){0};
    enum talus_status status = open_frame(path, &file, error);
    if (status == TALUS_OK)
        status = read_positions(file, data, error);
    if (status == TALUS_OK)
        status = read_time(file, data, error);
    if (status == TALUS_OK)
        status = read_point_data(file, field, data, error);
    if (file >= 0)
        (void)H5Fclose(file);
    return status;
}

void render_data_release(struct render_data *data)
{
    free(data->positions);
    free(data->values);
    free(data->volumes);
    free(data->gradients);
    memset(data, 0, sizeof *data);
}

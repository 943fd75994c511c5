/* SPDX-License-Identifier: Apache-2.0 */
#include "output/render_data.h"

#include "output/frame_read.h"
#include "output/hdf5_file.h"
#include "output/render_field.h"

#include <errno.h>
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static enum talus_status read_positions(hid_t file, struct render_data *data,
                                        struct talus_error *error)
{
    struct frame_values points;
    if (H5Lexists(file, "VTKHDF", H5P_DEFAULT) <= 0)
        return frame_read_failed(error, "VTKHDF");
    enum talus_status status = frame_read_array(file, "VTKHDF/Points", &points, error);
    if (status != TALUS_OK)
        return status;
    data->positions = points.values;
    data->count = points.count;
    return points.values == NULL || points.components != 3 ? frame_read_failed(error, "Points")
                                                           : TALUS_OK;
}

static enum talus_status read_time(hid_t file, struct render_data *data, struct talus_error *error)
{
    struct frame_values time;
    if (H5Lexists(file, "VTKHDF/FieldData", H5P_DEFAULT) <= 0)
        return frame_read_failed(error, "FieldData");
    enum talus_status status = frame_read_array(file, "VTKHDF/FieldData/Time", &time, error);
    if (status != TALUS_OK)
        return status;
    if (time.values == NULL || time.count == 0)
        status = frame_read_failed(error, "Time");
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
    enum talus_status status = frame_read_array(group, name, &array, error);
    if (status != TALUS_OK)
        return status;
    if (array.values == NULL)
        return talus_error_set(error, TALUS_INVALID, "unknown_value", "/field",
                               "the frame has no field '%s'; it has: %s", name, list.text);
    if (array.count != data->count)
        status = frame_read_failed(error, name);
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
    enum talus_status status = frame_read_array(group, name, &array, error);
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
        return frame_read_failed(error, "PointData");
    hid_t group = H5Gopen2(file, "VTKHDF/PointData", H5P_DEFAULT);
    if (group < 0)
        return frame_read_failed(error, "PointData");
    enum talus_status status = read_values(group, field, data, error);
    if (status == TALUS_OK)
        status = read_optional(group, "volume", data->count, 1, &data->volumes, error);
    if (status == TALUS_OK)
        status =
            read_optional(group, "deformation_gradient", data->count, 9, &data->gradients, error);
    (void)H5Gclose(group);
    return status;
}

enum talus_status render_data_read_positions(struct render_data *data, const char *path,
                                             struct talus_error *error)
{
    hid_t file = H5I_INVALID_HID;
    *data = (struct render_data){0};
    enum talus_status status = frame_read_open(path, &file, error);
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
    enum talus_status status = frame_read_open(path, &file, error);
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

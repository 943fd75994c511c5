/* SPDX-License-Identifier: Apache-2.0 */
#include "output/frame_slice.h"

#include "output/file.h"
#include "output/frame_read.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const uint64_t frame_slice_bytes_max = 200u << 20;

/* What a slice consists of while it is made. */
struct slice {
    uint64_t count, stride; /* particles in it */
    json_t *fields;         /* of the header */
    uint8_t *data;
    size_t length;
};

static enum talus_status no_memory(struct talus_error *error)
{
    return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a slice");
}

static void put_word(uint8_t *to, uint32_t word)
{
    for (int byte = 0; byte < 4; byte++)
        to[byte] = (uint8_t)(word >> (8 * byte));
}

static void put_float(uint8_t *to, double value)
{
    const float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    put_word(to, bits);
}

static enum talus_status add_array(struct slice *slice, const char *name,
                                   const struct frame_values *array, struct talus_error *error)
{
    const size_t bytes = (size_t)slice->count * array->components * 4;
    if (slice->length + bytes > frame_slice_bytes_max)
        return talus_error_set(error, TALUS_INVALID, "range", "/stride",
                               "the slice would have more than %" PRIu64 " bytes: take fewer "
                               "fields or a larger stride",
                               frame_slice_bytes_max);
    uint8_t *data = realloc(slice->data, slice->length + bytes + 1);
    if (data == NULL)
        return no_memory(error);
    slice->data = data;
    json_t *field =
        json_pack("{s:s, s:I, s:I, s:s}", "name", name, "components", (json_int_t)array->components,
                  "offset", (json_int_t)slice->length, "unit", array->unit);
    if (json_array_append_new(slice->fields, field) != 0)
        return no_memory(error);
    for (uint64_t index = 0; index < slice->count; index++) {
        const double *values = array->values + index * slice->stride * array->components;
        for (size_t component = 0; component < array->components; component++, slice->length += 4)
            put_float(slice->data + slice->length, values[component]);
    }
    return TALUS_OK;
}

static enum talus_status add_field(struct slice *slice, hid_t file, const char *name,
                                   uint64_t particle_count, struct talus_error *error)
{
    char path[128];
    struct frame_values array = {0};
    (void)snprintf(path, sizeof path, "VTKHDF/PointData/%s", name);
    enum talus_status status = TALUS_OK;
    if (strchr(name, '/') == NULL && strlen(name) < 64)
        status = frame_read_array(file, path, &array, error);
    if (status == TALUS_OK && array.values == NULL)
        status = talus_error_set(error, TALUS_INVALID, "unknown_value", "/fields",
                                 "the frame has no field '%s'", name);
    else if (status == TALUS_OK && array.count != particle_count)
        status = frame_read_failed(error, name);
    if (status == TALUS_OK)
        status = add_array(slice, name, &array, error);
    free(array.values);
    return status;
}

static enum talus_status read_slice(struct slice *slice, hid_t file,
                                    const struct frame_slice_request *request,
                                    struct talus_error *error)
{
    struct frame_values points;
    enum talus_status status = frame_read_array(file, "VTKHDF/Points", &points, error);
    if (status != TALUS_OK)
        return status;
    if (points.values == NULL)
        return frame_read_failed(error, "Points");
    const uint64_t particle_count = points.count;
    slice->stride = request->stride;
    slice->count = (particle_count + request->stride - 1) / request->stride;
    status = add_array(slice, "position", &points, error);
    free(points.values);
    for (size_t index = 0; index < request->field_count && status == TALUS_OK; index++)
        status = add_field(slice, file, request->fields[index], particle_count, error);
    return status;
}

/* Length, header and arrays in one piece; free() it, NULL when memory ran out. */
static uint8_t *assemble(const struct slice *slice, uint64_t frame, size_t *length)
{
    json_t *header = json_pack("{s:I, s:I, s:I, s:O}", "frame", (json_int_t)frame, "count",
                               (json_int_t)slice->count, "stride", (json_int_t)slice->stride,
                               "fields", slice->fields);
    char *text = header == NULL ? NULL : json_dumps(header, JSON_COMPACT);
    const size_t used = text == NULL ? 0 : strlen(text), padded = (used + 3) / 4 * 4;
    uint8_t *whole = text == NULL ? NULL : malloc(4 + padded + slice->length);
    if (whole != NULL) {
        *length = 4 + padded + slice->length;
        put_word(whole, (uint32_t)padded);
        memset(whole + 4, ' ', padded);
        for (size_t index = 0; index < used; index++)
            whole[4 + index] = (uint8_t)text[index];
        if (slice->data != NULL)
            memcpy(whole + 4 + padded, slice->data, slice->length);
    }
    free(text);
    json_decref(header);
    return whole;
}

enum talus_status frame_slice_write(const struct frame_slice_request *request,
                                    struct talus_error *error)
{
    char name[64], path[FILE_PATH_SIZE];
    hid_t file = H5I_INVALID_HID;
    struct slice slice = {.fields = json_array()};
    (void)snprintf(name, sizeof name, "frames/frame_%06" PRIu64 ".hdf", request->frame);
    enum talus_status status = file_path(path, request->folder, name, error);
    if (status == TALUS_OK)
        status = frame_read_open(path, &file, error);
    if (status == TALUS_OK)
        status = read_slice(&slice, file, request, error);
    if (file >= 0)
        (void)H5Fclose(file);
    size_t length = 0;
    uint8_t *whole = status == TALUS_OK ? assemble(&slice, request->frame, &length) : NULL;
    if (status == TALUS_OK)
        status = whole == NULL ? no_memory(error)
                               : file_write_whole(request->output, whole, length, error);
    free(whole);
    free(slice.data);
    json_decref(slice.fields);
    return status;
}

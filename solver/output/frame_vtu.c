/* SPDX-License-Identifier: Apache-2.0 */
/* VTK XML (VTK file formats documentation, "XML file formats"): one appended section, base64; each
 * array is its size in bytes (UInt64) and its values, encoded as one run. */
#include "output/file.h"
#include "output/frame.h"

#include <openssl/evp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VTK_VERTEX = 1 };

/* One array on its way into the file. */
struct vtu_array {
    const char *name, *type;
    size_t components, byte_count;
    void *bytes;
};

static size_t encoded_size(size_t byte_count)
{
    return (sizeof(uint64_t) + byte_count + 2) / 3 * 4;
}

/* Converts to the stored type, in new memory; NULL when memory ran out. */
static void *convert(const double *values, size_t count, enum frame_number number,
                     bool double_precision, size_t *byte_count)
{
    size_t width = number == FRAME_REAL && !double_precision ? sizeof(float) : sizeof(double);
    *byte_count = count * width;
    void *bytes = malloc(*byte_count == 0 ? 1 : *byte_count);
    if (bytes == NULL)
        return NULL;
    if (number == FRAME_INTEGER) {
        int64_t *out = bytes;
        for (size_t index = 0; index < count; index++)
            out[index] = (int64_t)values[index];
    } else if (double_precision) {
        memcpy(bytes, values, *byte_count);
    } else {
        float *out = bytes;
        for (size_t index = 0; index < count; index++)
            out[index] = (float)values[index];
    }
    return bytes;
}

static struct vtu_array real_array(const char *name, size_t components, const double *values,
                                   size_t point_count, enum frame_number number,
                                   bool double_precision)
{
    struct vtu_array array = {.name = name, .components = components};
    array.type = number == FRAME_INTEGER ? "Int64" : double_precision ? "Float64" : "Float32";
    array.bytes =
        convert(values, point_count * components, number, double_precision, &array.byte_count);
    return array;
}

/* first, first + 1, ...: connectivity (from 0) and VTK's end offsets (from 1) of vertices. */
static struct vtu_array counting_array(const char *name, int64_t first, size_t count)
{
    struct vtu_array array = {.name = name, .type = "Int64", .components = 1};
    array.byte_count = count * sizeof(int64_t);
    int64_t *numbers = malloc(array.byte_count == 0 ? 1 : array.byte_count);
    for (size_t index = 0; numbers != NULL && index < count; index++)
        numbers[index] = first + (int64_t)index;
    array.bytes = numbers;
    return array;
}

static struct vtu_array type_array(size_t count)
{
    struct vtu_array array = {.name = "types", .type = "UInt8", .components = 1};
    array.byte_count = count;
    array.bytes = malloc(count == 0 ? 1 : count);
    if (array.bytes != NULL)
        memset(array.bytes, VTK_VERTEX, count);
    return array;
}

static size_t write_declaration(FILE *stream, const struct vtu_array *array, size_t offset)
{
    (void)fprintf(stream,
                  "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%zu\" "
                  "format=\"appended\" offset=\"%zu\"/>\n",
                  array->type, array->name, array->components, offset);
    return offset + encoded_size(array->byte_count);
}

/* The size and the bytes as one base64 run. false when memory ran out. */
static bool write_encoded(FILE *stream, const struct vtu_array *array)
{
    uint64_t byte_count = array->byte_count;
    unsigned char block[3 * 4096];
    unsigned char text[4 * 4096 + 1];
    size_t filled = sizeof byte_count;
    size_t taken = 0;
    memcpy(block, &byte_count, sizeof byte_count);
    for (;;) {
        size_t room = sizeof block - filled;
        size_t part = array->byte_count - taken < room ? array->byte_count - taken : room;
        memcpy(block + filled, (const unsigned char *)array->bytes + taken, part);
        filled += part;
        taken += part;
        int length = EVP_EncodeBlock(text, block, (int)filled);
        if (fwrite(text, 1, (size_t)length, stream) != (size_t)length)
            return false;
        if (taken == array->byte_count)
            return true;
        filled = 0;
    }
}

/* Sections in the order of the file: fields, then position, connectivity, offsets, types. */
/* What a file holds. */
struct vtu_document {
    const struct frame *frame;
    const struct vtu_array *arrays;
    size_t count;
};

static bool write_document(FILE *stream, const void *context)
{
    const struct vtu_document *document = context;
    const struct frame *frame = document->frame;
    const struct vtu_array *arrays = document->arrays;
    const size_t count = document->count;
    size_t offset = 0;
    (void)fprintf(stream,
                  "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                  "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
                  "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
                  "NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n</FieldData>\n"
                  "<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n<PointData>\n",
                  frame->time, frame->point_count, frame->point_count);
    for (size_t index = 0; index < count - 4; index++)
        offset = write_declaration(stream, &arrays[index], offset);
    (void)fputs("</PointData>\n<Points>\n", stream);
    offset = write_declaration(stream, &arrays[count - 4], offset);
    (void)fputs("</Points>\n<Cells>\n", stream);
    for (size_t index = count - 3; index < count; index++)
        offset = write_declaration(stream, &arrays[index], offset);
    (void)fputs("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"base64\">\n_",
                stream);
    for (size_t index = 0; index < count; index++) {
        if (!write_encoded(stream, &arrays[index]))
            return false;
    }
    (void)fputs("\n</AppendedData>\n</VTKFile>\n", stream);
    return fflush(stream) == 0 && !ferror(stream);
}

enum talus_status frame_write_vtu(const struct frame *frame, const char *path,
                                  bool double_precision, struct talus_error *error)
{
    struct vtu_array arrays[FRAME_ARRAY_MAX + 4];
    size_t count = 0;
    for (; count < frame->array_count; count++) {
        const struct frame_array *source = &frame->arrays[count];
        arrays[count] = real_array(source->name, source->components, source->values,
                                   frame->point_count, source->number, double_precision);
    }
    arrays[count++] = real_array("position", 3, frame->positions, frame->point_count, FRAME_REAL,
                                 double_precision);
    arrays[count++] = counting_array("connectivity", 0, frame->point_count);
    arrays[count++] = counting_array("offsets", 1, frame->point_count);
    arrays[count++] = type_array(frame->point_count);
    enum talus_status status = TALUS_OK;
    for (size_t index = 0; index < count; index++) {
        if (arrays[index].bytes == NULL)
            status =
                talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a frame");
    }
    const struct vtu_document document = {.frame = frame, .arrays = arrays, .count = count};
    if (status == TALUS_OK)
        status = file_write_stream(path, write_document, &document, error);
    for (size_t index = 0; index < count; index++)
        free(arrays[index].bytes);
    return status;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "output/checkpoint_file.h"

#include "output/hdf5_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static enum talus_status write_blob(hid_t group, const struct talus_blob *blob, size_t index,
                                    struct talus_error *error)
{
    char name[24];
    (void)snprintf(name, sizeof name, "%06zu", index);
    struct hdf5_array array = {.name = name,
                               .unit = "byte",
                               .memory_type = H5T_NATIVE_UCHAR,
                               .file_type = H5T_STD_U8LE,
                               .count = blob->bytes,
                               .components = 1,
                               .data = blob->data,
                               .packing = HDF5_PLAIN};
    return hdf5_write_marked_array(group, &array, "name", blob->name, error);
}

enum talus_status checkpoint_write(const char *path, const char *state,
                                   const struct talus_blob *blobs, size_t blob_count,
                                   struct talus_error *error)
{
    struct hdf5_file file;
    hid_t group = H5I_INVALID_HID;
    enum talus_status status = hdf5_create(&file, path, error);
    if (status != TALUS_OK)
        return status;
    status = hdf5_write_text(file.file, "state", state, error);
    if (status == TALUS_OK)
        status = hdf5_create_group(file.file, "blobs", &group, error);
    for (size_t index = 0; status == TALUS_OK && index < blob_count; index++)
        status = write_blob(group, &blobs[index], index, error);
    if (group >= 0)
        (void)H5Gclose(group);
    if (status == TALUS_OK)
        status = hdf5_publish(&file, error);
    else
        hdf5_abandon(&file);
    return status;
}

static enum talus_status read_name(hid_t dataset, struct talus_blob *blob,
                                   struct talus_error *error)
{
    hid_t attribute = H5Aopen(dataset, "name", H5P_DEFAULT);
    if (attribute < 0)
        return hdf5_error(error, "open attribute", "name");
    enum talus_status status = TALUS_OK;
    hid_t type = H5Aget_type(attribute);
    if (type < 0 || H5Tget_class(type) != H5T_STRING || H5Tget_size(type) >= sizeof blob->name ||
        H5Aread(attribute, type, blob->name) < 0)
        status = hdf5_error(error, "read attribute", "name");
    if (type >= 0)
        (void)H5Tclose(type);
    (void)H5Aclose(attribute);
    return status;
}

static enum talus_status read_bytes(hid_t dataset, struct talus_blob *blob, void **memory,
                                    struct talus_error *error)
{
    hid_t space = H5Dget_space(dataset);
    if (space < 0)
        return hdf5_error(error, "read", "blob");
    hssize_t count = H5Sget_simple_extent_npoints(space);
    (void)H5Sclose(space);
    if (count < 0)
        return hdf5_error(error, "read", "blob");
    blob->bytes = (size_t)count;
    *memory = malloc(blob->bytes == 0 ? 1 : blob->bytes);
    if (*memory == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a checkpoint");
    blob->data = *memory;
    if (count > 0 && H5Dread(dataset, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, *memory) < 0)
        return hdf5_error(error, "read", "blob");
    return TALUS_OK;
}

static enum talus_status read_blob(hid_t group, size_t index, struct talus_blob *blob,
                                   void **memory, struct talus_error *error)
{
    char name[24];
    (void)snprintf(name, sizeof name, "%06zu", index);
    hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
    if (dataset < 0)
        return hdf5_error(error, "open blob", name);
    enum talus_status status = read_name(dataset, blob, error);
    if (status == TALUS_OK)
        status = read_bytes(dataset, blob, memory, error);
    (void)H5Dclose(dataset);
    return status;
}

/* Room for `count` blobs. */
static enum talus_status allocate_blobs(struct checkpoint *checkpoint, size_t count,
                                        struct talus_error *error)
{
    checkpoint->blobs = calloc(count + 1, sizeof *checkpoint->blobs);
    checkpoint->memory = calloc(count + 1, sizeof *checkpoint->memory);
    if (checkpoint->blobs == NULL || checkpoint->memory == NULL)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory for a checkpoint");
    checkpoint->blob_count = count;
    return TALUS_OK;
}

static enum talus_status read_blobs(struct checkpoint *checkpoint, hid_t file,
                                    struct talus_error *error)
{
    H5G_info_t information;
    hid_t group = H5Gopen2(file, "blobs", H5P_DEFAULT);
    if (group < 0)
        return hdf5_error(error, "open group", "blobs");
    enum talus_status status = TALUS_OK;
    if (H5Gget_info(group, &information) < 0) {
        status = hdf5_error(error, "inspect group", "blobs");
    } else {
        status = allocate_blobs(checkpoint, (size_t)information.nlinks, error);
        for (size_t index = 0; status == TALUS_OK && index < checkpoint->blob_count; index++)
            status = read_blob(group, index, &checkpoint->blobs[index], &checkpoint->memory[index],
                               error);
    }
    (void)H5Gclose(group);
    return status;
}

enum talus_status checkpoint_read(struct checkpoint *checkpoint, const char *path,
                                  struct talus_error *error)
{
    hid_t file = H5I_INVALID_HID;
    memset(checkpoint, 0, sizeof *checkpoint);
    enum talus_status status = hdf5_open(&file, path, error);
    if (status != TALUS_OK)
        return status;
    status = hdf5_read_text(file, "state", &checkpoint->state, error);
    if (status == TALUS_OK)
        status = read_blobs(checkpoint, file, error);
    (void)H5Fclose(file);
    if (status != TALUS_OK)
        checkpoint_release(checkpoint);
    return status;
}

void checkpoint_release(struct checkpoint *checkpoint)
{
    for (size_t index = 0; index < checkpoint->blob_count; index++)
        free(checkpoint->memory[index]);
    free(checkpoint->memory);
    free(checkpoint->blobs);
    free(checkpoint->state);
    memset(checkpoint, 0, sizeof *checkpoint);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "output/hdf5_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Rows of a chunk: large enough to pack well, small enough that one fits HDF5's chunk cache (1 MiB)
 * up to 16 doubles a row. */
enum { CHUNK_ROWS = 8192 };
/* Smaller datasets lie in the file as they are: the index of chunks would outweigh them. */
enum { PACKED_VALUES_MIN = 2048 };
/* Level 1 packs shuffled floats nearly as well as higher ones, at a third of their time. */
enum { GZIP_LEVEL = 1 };

struct stack_summary {
    int number; /* errno of the system call that failed; 0: none named */
    int out_of_memory;
    char text[200];
};

static herr_t summarise_entry(unsigned depth, const H5E_error2_t *entry, void *context)
{
    struct stack_summary *summary = context;
    if (depth == 0 || summary->text[0] == '\0')
        (void)snprintf(summary->text, sizeof summary->text, "%s", entry->desc);
    const char *number = strstr(entry->desc, "errno = ");
    if (number != NULL)
        summary->number = (int)strtol(number + strlen("errno = "), NULL, 10);
    if (entry->maj_num == H5E_RESOURCE && entry->min_num == H5E_NOSPACE)
        summary->out_of_memory = 1;
    return 0;
}

enum talus_status hdf5_error(struct talus_error *error, const char *action, const char *name)
{
    struct stack_summary summary = {0};
    (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, summarise_entry, &summary);
    if (summary.number != 0)
        return file_error(error, summary.number, action, name);
    if (summary.out_of_memory)
        return talus_error_set(error, TALUS_MEMORY, "memory", "", "out of memory: cannot %s %s",
                               action, name);
    return talus_error_set(error, TALUS_IO, "hdf5", "", "cannot %s %s: %s", action, name,
                           summary.text);
}

/* To be called before anything else of HDF5. Its errors are ours to print, and its clean-up at exit
 * must not run: it crashes on a file whose last write failed (HDF5 1.10, h5py issue 914), and we
 * close what we open. */
static void prepare_hdf5(void)
{
    (void)H5dont_atexit();
    (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

enum talus_status hdf5_create(struct hdf5_file *file, const char *path, struct talus_error *error)
{
    file->file = H5I_INVALID_HID;
    prepare_hdf5();
    if (snprintf(file->path, sizeof file->path, "%s", path) >= FILE_PATH_SIZE)
        return talus_error_set(error, TALUS_IO, "path", "", "path too long");
    enum talus_status status = file_aside_path(file->aside, path, error);
    if (status != TALUS_OK)
        return status;
    file->file = H5Fcreate(file->aside, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    return file->file < 0 ? hdf5_error(error, "create", file->aside) : TALUS_OK;
}

enum talus_status hdf5_publish(struct hdf5_file *file, struct talus_error *error)
{
    hid_t handle = file->file;
    /* A handle whose closing failed is still valid for HDF5, but must not be closed again. */
    file->file = H5I_INVALID_HID;
    if (H5Fclose(handle) < 0) {
        enum talus_status status = hdf5_error(error, "write", file->path);
        (void)unlink(file->aside);
        return status;
    }
    return file_publish(file->aside, file->path, error);
}

void hdf5_abandon(struct hdf5_file *file)
{
    if (file->file < 0)
        return;
    (void)H5Fclose(file->file);
    (void)unlink(file->aside);
    file->file = H5I_INVALID_HID;
}

enum talus_status hdf5_open(hid_t *file, const char *path, struct talus_error *error)
{
    prepare_hdf5();
    *file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    return *file < 0 ? hdf5_error(error, "open", path) : TALUS_OK;
}

enum talus_status hdf5_create_group(hid_t parent, const char *name, hid_t *group,
                                    struct talus_error *error)
{
    *group = H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    return *group < 0 ? hdf5_error(error, "create group", name) : TALUS_OK;
}

/* Creation properties of a dataset, or below 0. */
static hid_t dataset_properties(const struct hdf5_array *array)
{
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    if (properties < 0)
        return properties;
    herr_t result = H5Pset_obj_track_times(properties, 0);
    if (array->packing == HDF5_PACKED && array->count * array->components >= PACKED_VALUES_MIN) {
        hsize_t chunk[2] = {array->count < CHUNK_ROWS ? array->count : CHUNK_ROWS,
                            array->components};
        if (H5Pset_chunk(properties, array->components > 1 ? 2 : 1, chunk) < 0 ||
            H5Pset_shuffle(properties) < 0 || H5Pset_deflate(properties, GZIP_LEVEL) < 0)
            result = -1;
    }
    if (result < 0) {
        (void)H5Pclose(properties);
        return H5I_INVALID_HID;
    }
    return properties;
}

/* Errors are read at once where they arise: HDF5 clears its stack with the next call. */
static enum talus_status create_dataset(hid_t parent, const struct hdf5_array *array,
                                        hid_t *dataset, struct talus_error *error)
{
    hsize_t sizes[2] = {array->count, array->components};
    enum talus_status status = TALUS_OK;
    hid_t space = H5Screate_simple(array->components > 1 ? 2 : 1, sizes, NULL);
    if (space < 0)
        return hdf5_error(error, "describe dataset", array->name);
    hid_t properties = dataset_properties(array);
    if (properties < 0) {
        status = hdf5_error(error, "describe dataset", array->name);
    } else {
        *dataset = H5Dcreate2(parent, array->name, array->file_type, space, H5P_DEFAULT, properties,
                              H5P_DEFAULT);
        if (*dataset < 0)
            status = hdf5_error(error, "create dataset", array->name);
        (void)H5Pclose(properties);
    }
    (void)H5Sclose(space);
    return status;
}

enum talus_status hdf5_write_array(hid_t parent, const struct hdf5_array *array,
                                   struct talus_error *error)
{
    hid_t dataset = H5I_INVALID_HID;
    enum talus_status status = create_dataset(parent, array, &dataset, error);
    if (status != TALUS_OK)
        return status;
    if (array->count > 0 &&
        H5Dwrite(dataset, array->memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array->data) < 0)
        status = hdf5_error(error, "write dataset", array->name);
    if (status == TALUS_OK)
        status = hdf5_write_attribute(dataset, "units", array->unit, error);
    /* Closing flushes chunks: it can fail like a write. */
    if (H5Dclose(dataset) < 0 && status == TALUS_OK)
        status = hdf5_error(error, "write dataset", array->name);
    return status;
}

/* A fixed-length string type for `length` bytes; close it with H5Tclose. */
static hid_t text_type(size_t length, H5T_cset_t characters)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    if (type < 0)
        return type;
    if (H5Tset_size(type, length == 0 ? 1 : length) < 0 ||
        H5Tset_strpad(type, H5T_STR_NULLPAD) < 0 || H5Tset_cset(type, characters) < 0) {
        (void)H5Tclose(type);
        return H5I_INVALID_HID;
    }
    return type;
}

enum talus_status hdf5_write_attribute(hid_t object, const char *name, const char *text,
                                       struct talus_error *error)
{
    hid_t type = text_type(strlen(text), H5T_CSET_ASCII);
    if (type < 0)
        return hdf5_error(error, "describe attribute", name);
    hid_t attribute = H5I_INVALID_HID;
    enum talus_status status = TALUS_OK;
    hid_t space = H5Screate(H5S_SCALAR);
    if (space >= 0)
        attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0 || H5Awrite(attribute, type, text) < 0)
        status = hdf5_error(error, "write attribute", name);
    if (attribute >= 0)
        (void)H5Aclose(attribute);
    if (space >= 0)
        (void)H5Sclose(space);
    (void)H5Tclose(type);
    return status;
}

static enum talus_status create_text(hid_t parent, const char *name, hid_t type, hid_t *dataset,
                                     struct talus_error *error)
{
    enum talus_status status = TALUS_OK;
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    if (space >= 0 && properties >= 0 && H5Pset_obj_track_times(properties, 0) >= 0)
        *dataset = H5Dcreate2(parent, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    if (*dataset < 0)
        status = hdf5_error(error, "create text", name);
    if (properties >= 0)
        (void)H5Pclose(properties);
    if (space >= 0)
        (void)H5Sclose(space);
    return status;
}

enum talus_status hdf5_write_text(hid_t parent, const char *name, const char *text,
                                  struct talus_error *error)
{
    hid_t type = text_type(strlen(text), H5T_CSET_UTF8);
    if (type < 0)
        return hdf5_error(error, "describe text", name);
    hid_t dataset = H5I_INVALID_HID;
    enum talus_status status = create_text(parent, name, type, &dataset, error);
    if (status == TALUS_OK && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) < 0)
        status = hdf5_error(error, "write text", name);
    if (status == TALUS_OK)
        status = hdf5_write_attribute(dataset, "units", "1", error);
    if (dataset >= 0 && H5Dclose(dataset) < 0 && status == TALUS_OK)
        status = hdf5_error(error, "write text", name);
    (void)H5Tclose(type);
    return status;
}

static enum talus_status read_text_dataset(hid_t dataset, const char *name, char **text,
                                           struct talus_error *error)
{
    hid_t type = H5Dget_type(dataset);
    if (type < 0)
        return hdf5_error(error, "read text", name);
    enum talus_status status = TALUS_OK;
    char *buffer = NULL;
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
        status = talus_error_set(error, TALUS_IO, "hdf5", "", "%s is not a text", name);
    else if ((buffer = calloc(H5Tget_size(type) + 1, 1)) == NULL)
        status = talus_error_memory(error);
    else if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer) < 0)
        status = hdf5_error(error, "read text", name);
    (void)H5Tclose(type);
    if (status != TALUS_OK) {
        free(buffer);
        return status;
    }
    *text = buffer;
    return TALUS_OK;
}

enum talus_status hdf5_read_text(hid_t parent, const char *name, char **text,
                                 struct talus_error *error)
{
    hid_t dataset = H5Dopen2(parent, name, H5P_DEFAULT);
    if (dataset < 0)
        return hdf5_error(error, "open text", name);
    enum talus_status status = read_text_dataset(dataset, name, text, error);
    (void)H5Dclose(dataset);
    return status;
}

enum talus_status hdf5_write_marked_array(hid_t parent, const struct hdf5_array *array,
                                          const char *attribute, const char *text,
                                          struct talus_error *error)
{
    enum talus_status status = hdf5_write_array(parent, array, error);
    if (status != TALUS_OK)
        return status;
    hid_t dataset = H5Dopen2(parent, array->name, H5P_DEFAULT);
    if (dataset < 0)
        return hdf5_error(error, "open dataset", array->name);
    status = hdf5_write_attribute(dataset, attribute, text, error);
    (void)H5Dclose(dataset);
    return status;
}

/* SPDX-License-Identifier: Apache-2.0 */
/* One complete HDF5 file, written aside and published when it is closed. Only gzip and shuffle, so
 * that every reader has the filters; every dataset carries its unit as the attribute `units`; no
 * time stamps, so that equal contents are equal files. */
#ifndef TALUS_HDF5_FILE_H
#define TALUS_HDF5_FILE_H

#include "output/file.h"
#include "talus/status.h"

#include <hdf5.h>
#include <stddef.h>

struct hdf5_file {
    hid_t file; /* below 0 when there is none */
    char path[FILE_PATH_SIZE], aside[FILE_PATH_SIZE];
};

/* Starts a new file that will become `path`. End with hdf5_publish or hdf5_abandon. */
TALUS_MUST_CHECK enum talus_status hdf5_create(struct hdf5_file *file, const char *path,
                                               struct talus_error *error);
/* Closes, syncs and renames the file. On failure it is removed. */
TALUS_MUST_CHECK enum talus_status hdf5_publish(struct hdf5_file *file, struct talus_error *error);
/* Drops an unfinished file; does nothing after hdf5_publish. */
void hdf5_abandon(struct hdf5_file *file);

/* An existing file, for reading. Close it with H5Fclose. */
TALUS_MUST_CHECK enum talus_status hdf5_open(hid_t *file, const char *path,
                                             struct talus_error *error);

/* A new group; close it with H5Gclose. */
TALUS_MUST_CHECK enum talus_status hdf5_create_group(hid_t parent, const char *name, hid_t *group,
                                                     struct talus_error *error);

enum hdf5_packing { HDF5_PLAIN, HDF5_PACKED };

struct hdf5_array {
    const char *name, *unit;
    hid_t memory_type, file_type; /* HDF5 converts */
    size_t count, components;     /* 1 component: rank 1, else rank 2 */
    const void *data;             /* [count * components] of memory_type */
    enum hdf5_packing packing;
};
TALUS_MUST_CHECK enum talus_status hdf5_write_array(hid_t parent, const struct hdf5_array *array,
                                                    struct talus_error *error);
/* The same with one more attribute of the dataset. */
TALUS_MUST_CHECK enum talus_status hdf5_write_marked_array(hid_t parent,
                                                           const struct hdf5_array *array,
                                                           const char *attribute, const char *text,
                                                           struct talus_error *error);

/* A scalar dataset of UTF-8 text, and one that is read back (*text belongs to the caller). */
TALUS_MUST_CHECK enum talus_status hdf5_write_text(hid_t parent, const char *name, const char *text,
                                                   struct talus_error *error);
TALUS_MUST_CHECK enum talus_status hdf5_read_text(hid_t parent, const char *name, char **text,
                                                  struct talus_error *error);

/* A fixed-length ASCII string attribute. */
TALUS_MUST_CHECK enum talus_status
hdf5_write_attribute(hid_t object, const char *name, const char *text, struct talus_error *error);

/* Sets *error from HDF5's error stack: out of disk is TALUS_LIMIT, out of memory TALUS_MEMORY. */
enum talus_status hdf5_error(struct talus_error *error, const char *action, const char *name);

#endif

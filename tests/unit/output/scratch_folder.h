/* SPDX-License-Identifier: Apache-2.0 */
/* A folder of its own for each test, removed afterwards (cmocka setup and teardown). */
#ifndef TALUS_SCRATCH_FOLDER_H
#define TALUS_SCRATCH_FOLDER_H

#include <stddef.h>

/* *state becomes the folder's path. */
int scratch_folder_make(void **state);
int scratch_folder_remove(void **state);

/* path = folder/name; returns path. */
enum { SCRATCH_PATH_SIZE = 4096 };
const char *scratch_path(char path[SCRATCH_PATH_SIZE], const char *folder, const char *name);

/* Contents of a file as text of at most `size` - 1 bytes; returns its length. */
size_t scratch_read(const char *path, char *text, size_t size);
/* Appends text to a file. */
void scratch_append(const char *path, const char *text);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Files and folders that survive a power cut: what these functions made is on disk when they
 * return. */
#ifndef TALUS_FOLDER_H
#define TALUS_FOLDER_H

#include "talus/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Makes a folder and its parents (mode 0750); an existing one is fine. */
TALUS_MUST_CHECK enum talus_status folder_make(const char *path, struct talus_error *error);
/* Writes a file that must not exist yet and flushes it. */
TALUS_MUST_CHECK enum talus_status folder_write(const char *folder, const char *name,
                                                const char *data, size_t length,
                                                struct talus_error *error);
/* Writes a file aside and puts it in the place of what was there. */
TALUS_MUST_CHECK enum talus_status folder_replace(const char *folder, const char *name,
                                                  const char *data, size_t length,
                                                  struct talus_error *error);
/* Flushes a folder's entries. */
TALUS_MUST_CHECK enum talus_status folder_sync(const char *path, struct talus_error *error);
/* Removes a folder with all that is in it; symbolic links are removed, not followed. A folder that
 * is not there is fine. */
TALUS_MUST_CHECK enum talus_status folder_remove(const char *path, struct talus_error *error);
/* Bytes of all files under a folder (their lengths); 0 if it is not there. */
int64_t folder_size(const char *path);
/* Bytes that are free where a folder is; negative if the system does not say. */
double folder_free_bytes(const char *path);
/* "a/b" -> new string, NULL without memory. */
char *folder_join(const char *folder, const char *name);
/* Whether `name` may be read by a client: relative, no empty, hidden or unfinished component
 * (".", "..", ".x", "x.tmp", "x.part"), no control characters, and not a file that only the
 * machinery uses (the lock). */
bool folder_name_public(const char *name);
/* Opens a regular file under `folder` for reading, following no symbolic link on the way. Returns
 * the descriptor, or -1. */
int folder_open(const char *folder, const char *name);
/* Visits every public regular file in the order of names, `name` relative to the folder; stops when
 * `visit` is false. */
void folder_list(const char *folder, bool (*visit)(const char *name, void *context), void *context);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Files that are never seen half-written: a file is written aside (`.NAME.part` in the same
 * folder), synced, renamed, and the rename itself is synced.
 *
 * Errors: a full disk, a quota or a file size limit is TALUS_LIMIT with code "disk_limit", lack of
 * memory TALUS_MEMORY, all else TALUS_IO. */
#ifndef TALUS_FILE_H
#define TALUS_FILE_H

#include "talus/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { FILE_PATH_SIZE = 4096 };

/* Sets *error from an errno value: what was tried with which file, and the status that fits. */
enum talus_status file_error(struct talus_error *error, int number, const char *action,
                             const char *path);

/* path = folder/name. */
TALUS_MUST_CHECK enum talus_status file_path(char path[FILE_PATH_SIZE], const char *folder,
                                             const char *name, struct talus_error *error);

/* aside = the name beside `path` under which it is written first. */
TALUS_MUST_CHECK enum talus_status file_aside_path(char aside[FILE_PATH_SIZE], const char *path,
                                                   struct talus_error *error);

/* Syncs the complete file `aside`, renames it to `path` and syncs the folder. On failure `aside` is
 * removed and `path` is as before. */
TALUS_MUST_CHECK enum talus_status file_publish(const char *aside, const char *path,
                                                struct talus_error *error);

/* Replaces `path` by `length` bytes, at once. */
TALUS_MUST_CHECK enum talus_status file_write_whole(const char *path, const void *data,
                                                    size_t length, struct talus_error *error);

/* Replaces `path` by what `write` puts into the stream, at once; `write` says whether all went
 * well.
 */
TALUS_MUST_CHECK enum talus_status
file_write_stream(const char *path, bool (*write)(FILE *stream, const void *context),
                  const void *context, struct talus_error *error);

/* Reads a file; *text (NUL-terminated, `length` bytes without it) belongs to the caller. */
TALUS_MUST_CHECK enum talus_status file_read_whole(const char *path, char **text, size_t *length,
                                                   struct talus_error *error);

/* Makes a folder and its parents; one that exists is fine. */
TALUS_MUST_CHECK enum talus_status file_make_folder(const char *path, struct talus_error *error);

/* Writes all of `data` to a descriptor; returns 0 or an errno value. */
TALUS_MUST_CHECK int file_write_all(int descriptor, const void *data, size_t length);

/* Removes the files of `folder` (which may not exist) whose names are to go. */
TALUS_MUST_CHECK enum talus_status
file_remove_some(const char *folder, bool (*goes)(const char *name, const void *context),
                 const void *context, struct talus_error *error);

/* Removes the files written aside that a killed run left in `folder` (which may not exist). */
TALUS_MUST_CHECK enum talus_status file_remove_asides(const char *folder,
                                                      struct talus_error *error);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Remembers the SHA-256 of files by identity, length and time, so that a list is cheap the second
 * time. */
#ifndef TALUS_FILE_CHECKSUMS_H
#define TALUS_FILE_CHECKSUMS_H

#include "checksum.h"

struct file_checksums;

TALUS_MUST_CHECK enum talus_status file_checksums_create(struct file_checksums **checksums,
                                                         struct talus_error *error);
void file_checksums_destroy(struct file_checksums *checksums);
/* The checksum of an open file. */
TALUS_MUST_CHECK enum talus_status file_checksum(struct file_checksums *checksums, int descriptor,
                                                 char checksum[CHECKSUM_SIZE],
                                                 struct talus_error *error);

#endif

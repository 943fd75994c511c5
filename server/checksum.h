/* SPDX-License-Identifier: Apache-2.0 */
/* SHA-256 as 64 hexadecimal digits. */
#ifndef TALUS_CHECKSUM_H
#define TALUS_CHECKSUM_H

#include "talus/status.h"

#include <jansson.h>
#include <stddef.h>

enum { CHECKSUM_SIZE = 65 };

TALUS_MUST_CHECK enum talus_status checksum_memory(const void *data, size_t length,
                                                   char checksum[CHECKSUM_SIZE],
                                                   struct talus_error *error);
/* From the descriptor's start to its end; the file offset is not used. */
TALUS_MUST_CHECK enum talus_status checksum_descriptor(int descriptor, char checksum[CHECKSUM_SIZE],
                                                       struct talus_error *error);
/* Equal for equal JSON: keys sorted, no white space, 1.0 written as 1. */
TALUS_MUST_CHECK enum talus_status checksum_json(const json_t *value, char checksum[CHECKSUM_SIZE],
                                                 struct talus_error *error);

#endif

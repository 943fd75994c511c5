/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_DIGEST_H
#define TALUS_DIGEST_H

#include "talus/status.h"

/* SHA-256 of a file as 64 hexadecimal digits and NUL. TALUS_IO if it cannot be read. */
TALUS_MUST_CHECK enum talus_status digest_file(const char *path, char hexadecimal[65],
                                               struct talus_error *error);

#endif

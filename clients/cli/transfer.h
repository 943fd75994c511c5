/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_TRANSFER_H
#define TALUS_TRANSFER_H

#include "connection.h"

#include <stdint.h>

/* A file of a job as the server lists it. */
struct remote_file {
    const char *name;   /* "frames/frame_000000.hdf" */
    const char *sha256; /* 64 hexadecimal digits, or "" */
    int64_t bytes;
};

enum transfer_outcome { TRANSFER_DONE, TRANSFER_ALREADY_THERE, TRANSFER_FAILED };

/* Whether a server's name stays inside the folder into which it is fetched. */
bool transfer_name_is_safe(const char *name);

/* Fetches a file into folder/name: by way of folder/name.part, which a later call goes on from
 * (Range), checked against the SHA-256 and then renamed. A file that is there with the right sum is
 * left alone. On TRANSFER_FAILED the reason is printed and *code is the exit code. */
enum transfer_outcome transfer_file(struct connection *connection, const char *id,
                                    const struct remote_file *file, const char *folder, int *code);

#endif

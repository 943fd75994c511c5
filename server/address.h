/* SPDX-License-Identifier: Apache-2.0 */
/* Where the daemon listens: an address or a Unix socket. */
#ifndef TALUS_ADDRESS_H
#define TALUS_ADDRESS_H

#include "talus/status.h"

#include <stdbool.h>
#include <stddef.h>

enum { ADDRESS_TEXT_SIZE = 160 };

/* Makes a listening socket. `text` gets the address as clients write it ("http://127.0.0.1:8465" or
 * "unix:/run/talus"). TALUS_INVALID for a malformed address. A stale Unix socket is replaced. */
TALUS_MUST_CHECK enum talus_status address_listen(const char *listen_text, int *descriptor,
                                                  char text[ADDRESS_TEXT_SIZE],
                                                  struct talus_error *error);
/* Whether a listening socket can be reached from this machine only: loopback or a Unix socket. */
bool address_is_local(int descriptor);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Where the client finds its token: never on the command line, which everyone on a machine can see.
 */
#ifndef TALUS_TOKEN_SOURCE_H
#define TALUS_TOKEN_SOURCE_H

#include <stdbool.h>

enum { TOKEN_SOURCE_SIZE = 514 }; /* the longest token, a line end and a NUL */

/* The first line of a file; without one (NULL) $TALUS_TOKEN, or "" if that is not set. False, with
 * a message on stderr, if the file cannot be read or what was found cannot be a token. */
bool token_source_read(const char *path, char token[TOKEN_SOURCE_SIZE]);

#endif

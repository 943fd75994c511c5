/* SPDX-License-Identifier: Apache-2.0 */
/* The configuration file: a JSON object with the keys of config.def. */
#ifndef TALUS_CONFIG_FILE_H
#define TALUS_CONFIG_FILE_H

#include "config.h"

/* Fills the members that are still unset (NULL, NaN): the command line has spoken before.
 * TALUS_INVALID, with a text for people, for anything the daemon does not know. */
TALUS_MUST_CHECK enum talus_status config_file_read(struct config *config, const char *path,
                                                    struct talus_error *error);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
/* Options of the daemon, from the command line and a configuration file; the command line wins. */
#ifndef TALUS_CONFIG_H
#define TALUS_CONFIG_H

#include "talus/status.h"

#include <stdbool.h>
#include <stdio.h>

/* Owns its texts. */
struct config {
#define CONFIG_TEXT(key, fallback, meaning) char *key;
#define CONFIG_NUMBER(key, fallback, low, high, meaning) double key;
#define CONFIG_FLAG(key, meaning) bool key;
#define CONFIG_LIST(key, meaning) char **key; /* ends with NULL; NULL: none */
#include "config.def"
#undef CONFIG_TEXT
#undef CONFIG_NUMBER
#undef CONFIG_FLAG
#undef CONFIG_LIST
    bool help, version;
};

/* Reads the arguments, then the file they name, then fills in defaults. The state folder and the
 * program of the workers are found as the manual says. */
TALUS_MUST_CHECK enum talus_status config_read(struct config *config, int argument_count,
                                               char **arguments, struct talus_error *error);
void config_release(struct config *config);
void config_usage(FILE *stream);

#endif

/* SPDX-License-Identifier: Apache-2.0 */
#ifndef TALUS_JSON_FILE_H
#define TALUS_JSON_FILE_H

#include <jansson.h>

/* The document in a file of a job's folder; NULL if there is none. (json_loadfd makes a system call
 * for every byte.) */
json_t *json_file_load(const char *folder, const char *name);

#endif

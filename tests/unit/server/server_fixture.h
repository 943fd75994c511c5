/* SPDX-License-Identifier: Apache-2.0 */
/* A scratch folder and a job, for the tests of the daemon's parts. */
#ifndef TALUS_SERVER_FIXTURE_H
#define TALUS_SERVER_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "job.h"

/* A new folder under the system's place for temporary files; fixture_folder_remove frees it. */
char *fixture_folder(void);
void fixture_folder_remove(char *folder);
/* Writes (or, with append, extends) a file of a folder. */
void fixture_write(const char *folder, const char *name, const void *data, size_t length,
                   int append);
/* A queued job with this id. */
struct job fixture_job(const char *id);

#endif

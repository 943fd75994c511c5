/* SPDX-License-Identifier: Apache-2.0 */
/* A scratch folder, a store and a job, for the tests of the daemon's parts. */
#ifndef TALUS_SERVER_FIXTURE_H
#define TALUS_SERVER_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "job.h"
#include "store.h"

/* A new folder under the system's place for temporary files; fixture_folder_remove frees it. */
char *fixture_folder(void);
void fixture_folder_remove(char *folder);
/* Writes (or, with append, extends) a file of a folder. */
void fixture_write(const char *folder, const char *name, const void *data, size_t length,
                   int append);
/* An empty store in a folder of its own, as the state of a STORE_TEST. */
struct store_fixture {
    char *folder, *path;
    struct store *store;
};
int store_fixture_setup(void **state);
int store_fixture_teardown(void **state);
#define STORE_TEST(test)                                                                           \
    cmocka_unit_test_setup_teardown(test, store_fixture_setup, store_fixture_teardown)
/* A queued job with this id. */
struct job fixture_job(const char *id);

#endif
